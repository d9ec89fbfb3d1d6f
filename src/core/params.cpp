#include "core/params.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "core/material.h"
#include "core/plugin.h"
#include "core/texture.h"

namespace frond {
namespace {

/// Types that a scene file can give for a kind, and how many numbers make one value; 0: any number.
struct KindTraits {
  std::vector<std::string_view> types;
  size_t arity;
};

const KindTraits& traits(ParamKind kind) {
  static const std::array<KindTraits, 16> table{{
      {{"bool"}, 1},
      {{"integer"}, 1},
      {{"float"}, 1},
      {{"string"}, 1},
      {{"point2"}, 2},
      {{"vector2"}, 2},
      {{"point3", "point"}, 3},
      {{"vector3", "vector"}, 3},
      {{"normal", "normal3"}, 3},
      {{"rgb", "spectrum", "blackbody"}, 0},
      {{"rgb", "spectrum", "blackbody"}, 0},
      {{"float", "rgb", "spectrum", "blackbody"}, 0},
      {{"rgb"}, 3},
      {{"float", "texture"}, 1},
      {{"rgb", "spectrum", "blackbody", "texture"}, 0},
      {{"string"}, 1},
  }};
  return table[static_cast<size_t>(kind)];
}

bool accepts(const PluginInfo& info, const ParsedParam& given) {
  const auto declared = std::ranges::find(info.params, given.name, &Param::name);
  if (declared == info.params.end()) return false;
  const auto& types = traits(declared->kind).types;
  return std::ranges::find(types, given.type) != types.end();
}

/// "an rgb", "a float".
std::string with_article(std::string_view type) {
  const bool is_vowel_spoken = type == "rgb" || std::string_view("aeiou").find(type[0]) != std::string_view::npos;
  return fmt::format("{} {}", is_vowel_spoken ? "an" : "a", type);
}

size_t value_count(const ParsedParam& p) {
  return std::visit([](const auto& v) { return v.size(); }, p.values);
}

const std::vector<double>& number_values(const ParsedParam& p) { return std::get<std::vector<double>>(p.values); }
const std::vector<std::string>& string_values(const ParsedParam& p) {
  return std::get<std::vector<std::string>>(p.values);
}

Vec3 vec3_at(const std::vector<double>& v, size_t i) {
  return {static_cast<float>(v[i]), static_cast<float>(v[i + 1]), static_cast<float>(v[i + 2])};
}

/// A default that is a number.
std::optional<double> default_number(const Default& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<int>(&value)) return double(*whole);
  return {};
}

[[noreturn]] void fail_without_value(const PluginInfo& info, const Param& declared) {
  throw std::logic_error(
      fmt::format("{} \"{}\" reads parameter \"{}\", which the scene does not give and which has no "
                  "default of its kind",
                  info.kind, info.name, declared.name));
}

double number_by_default(const PluginInfo& info, const Param& declared) {
  if (const auto number = default_number(declared.default_value)) return *number;
  fail_without_value(info, declared);
}

template <class T>
const T& value_by_default(const PluginInfo& info, const Param& declared) {
  if (const T* value = std::get_if<T>(&declared.default_value)) return *value;
  fail_without_value(info, declared);
}

/// Type of default that the parameter's kind requires; empty if the given default has it. There must be a default.
std::string_view wrong_default(const Param& declared) {
  const Default& value = declared.default_value;
  const bool is_number = default_number(value).has_value(),
             is_triple = std::holds_alternative<std::array<double, 3>>(value);
  switch (declared.kind) {
    case ParamKind::boolean:
      return std::holds_alternative<bool>(value) ? "" : "true or false";
    case ParamKind::integer:
      return std::holds_alternative<int>(value) ? "" : "an int";
    case ParamKind::real:
    case ParamKind::float_texture:
      return is_number ? "" : "a number";
    case ParamKind::string:
    case ParamKind::material:
      return std::holds_alternative<std::string_view>(value) ? "" : "a string";
    case ParamKind::point2:
    case ParamKind::vector2:
    case ParamKind::point3:
    case ParamKind::vector3:
    case ParamKind::normal3:
    case ParamKind::rgb:
      return is_triple ? "" : "three numbers";
    case ParamKind::illuminant:
    case ParamKind::albedo:
    case ParamKind::unbounded:
    case ParamKind::spectrum_texture:
      return is_number || is_triple ? "" : "a number or three";
  }
  return "of a known kind";
}

/// Numbers of a default; empty for other types.
std::vector<double> numbers_of(const Default& value) {
  if (const auto x = default_number(value)) return {*x};
  if (const auto* triple = std::get_if<std::array<double, 3>>(&value)) return {triple->begin(), triple->end()};
  return {};
}

/// First error of a single declaration; empty if there is none.
std::string problem_of(const Param& p) {
  if (p.name.empty()) return "a parameter has no name";
  if (!(p.range.min <= p.range.max))
    return fmt::format("\"{}\" has a range from {} to {}", p.name, p.range.min, p.range.max);
  if (!p.choices.empty() && p.kind != ParamKind::string)
    return fmt::format("\"{}\" has choices, which only strings can have", p.name);
  if (std::holds_alternative<std::monostate>(p.default_value)) return "";
  if (const std::string_view takes = wrong_default(p); !takes.empty())
    return fmt::format("the default of \"{}\" has the wrong type: it takes {}", p.name, takes);
  for (const double x : numbers_of(p.default_value)) {
    if (!std::isfinite(x)) return fmt::format("the default of \"{}\" is {}: finite numbers are needed", p.name, x);
    if (!p.range.contains(x))
      return fmt::format("the default of \"{}\" is {}, outside its range {} to {}", p.name, x, p.range.min,
                         p.range.max);
  }
  if (const auto* word = std::get_if<std::string_view>(&p.default_value);
      word && !p.choices.empty() && std::ranges::find(p.choices, *word) == p.choices.end())
    return fmt::format("the default of \"{}\" is \"{}\", which is none of {}", p.name, *word,
                       fmt::join(p.choices, ", "));
  return "";
}

/// A default of three numbers is "rgb"; of one number, that value at every wavelength ("spectrum" [360 x 2500 x]).
ParsedParam default_spectrum(const PluginInfo& info, const Param& declared, const Location& where) {
  ParsedParam p{"rgb", std::string(declared.name), where, where, {}};
  if (const auto level = default_number(declared.default_value)) {
    p.type = "spectrum";
    p.values = std::vector<double>{360, *level, 2500, *level};
  } else {
    const auto& rgb = value_by_default<std::array<double, 3>>(info, declared);
    p.values = std::vector<double>(rgb.begin(), rgb.end());
  }
  return p;
}

}  // namespace

std::string declaration_problem(const PluginInfo& info) {
  for (auto p = info.params.begin(); p != info.params.end(); ++p) {
    if (std::find_if(info.params.begin(), p, [p](const Param& q) { return q.name == p->name; }) != p)
      return fmt::format("parameter \"{}\" is declared twice", p->name);
    if (const std::string problem = problem_of(*p); !problem.empty()) return problem;
  }
  return "";
}

Params::Params(const PluginInfo& info, const ParsedPlugin& parsed, ParamResolver& resolver)
    : info_(info), parsed_(parsed), resolver_(resolver), read_(info.params.size(), false) {
  std::vector<std::string_view> names;
  for (const Param& p : info_.params) names.push_back(p.name);
  std::erase_if(parsed_.params, [&](const ParsedParam& p) { return p.may_be_unused && !accepts(info_, p); });
  for (size_t i = 0; i < parsed_.params.size(); ++i) {
    const ParsedParam& p = parsed_.params[i];
    const auto declared = std::find(names.begin(), names.end(), p.name);
    if (declared == names.end())
      fail(p.where, "{} \"{}\" has no parameter \"{}\"{}", info_.kind, info_.name, p.name, suggestion(p.name, names));
    for (size_t j = 0; j < i; ++j)
      if (parsed_.params[j].name == p.name) fail(p.where, "parameter \"{}\" is given twice", p.name);
    check(info_.params[static_cast<size_t>(declared - names.begin())], p);
  }
  for (const Param& p : info_.params)
    if (p.required && !given(p.name))
      fail(parsed_.where, "{} \"{}\" needs parameter \"{} {}\"", info_.kind, info_.name, traits(p.kind).types[0],
           p.name);
}

namespace {

/// Warns if all numbers but 0 are probably in another unit.
void warn_of_unit(ParamResolver& resolver, const Param& declared, std::span<const double> values,
                  const Location& where) {
  std::string first;
  for (const double x : values) {
    if (x == 0) continue;
    const std::string hint = unit_hint(x, declared.quantity, declared.unit, declared.range);
    if (hint.empty()) return;
    if (first.empty())
      first =
          fmt::format("\"{}\" is {}{}{}: {}", declared.name, x, declared.unit.empty() ? "" : " ", declared.unit, hint);
  }
  if (!first.empty()) resolver.warn(where, first);
}

}  // namespace

void Params::check(const Param& declared, const ParsedParam& p) const {
  const auto& [types, arity] = traits(declared.kind);
  if (std::find(types.begin(), types.end(), p.type) == types.end())
    fail(p.where, "\"{}\" is {}, {} was given", p.name, fmt::join(types, " or "), with_article(p.type));
  const size_t count = value_count(p), unit = p.type == "texture" ? 1 : arity;
  if (unit > 0) {
    if (!declared.list && count != unit)
      fail(p.value_where, "\"{}\" takes {} value{}, {} given", p.name, unit, unit == 1 ? "" : "s", count);
    if (count % unit != 0) fail(p.value_where, "\"{}\" takes values in groups of {}, {} given", p.name, unit, count);
  }
  if (const auto* v = std::get_if<std::vector<double>>(&p.values); v && unit > 0) {
    for (const double x : *v) {
      if (!std::isfinite(x)) fail(p.value_where, "\"{}\" has the value {}, finite numbers are needed", p.name, x);
      if (declared.range.contains(x)) continue;
      const std::string_view space = declared.unit.empty() ? "" : " ";
      const std::string hint = unit_hint(x, declared.quantity, declared.unit, declared.range);
      fail(p.value_where, "\"{}\" is {}, outside its range {} to {}{}{}{}{}", p.name, x, declared.range.min,
           declared.range.max, space, declared.unit, hint.empty() ? "" : "; ", hint);
    }
    warn_of_unit(resolver_, declared, *v, p.value_where);
    if (declared.kind == ParamKind::integer)
      for (const double x : *v)
        if (x != std::floor(x) || std::abs(x) > std::numeric_limits<int>::max())
          fail(p.value_where, "\"{}\" is an integer, {} was given", p.name, x);
  }
  if (!declared.choices.empty())
    for (const std::string& word : string_values(p))
      if (std::find(declared.choices.begin(), declared.choices.end(), word) == declared.choices.end())
        fail(p.value_where, "\"{}\" is one of {}, \"{}\" was given", p.name, fmt::join(declared.choices, ", "), word);
}

Params::Found Params::find(std::string_view name) const {
  for (size_t i = 0; i < info_.params.size(); ++i) {
    if (info_.params[i].name != name) continue;
    read_[i] = true;
    for (const ParsedParam& p : parsed_.params)
      if (p.name == name) return {info_.params[i], &p};
    return {info_.params[i], nullptr};
  }
  throw std::logic_error(fmt::format("{} \"{}\" reads undeclared parameter \"{}\"", info_.kind, info_.name, name));
}

bool Params::given(std::string_view name) const { return find(name).parsed != nullptr; }

std::string_view Params::plugin() const { return info_.name; }

Params Params::forwarded(const PluginInfo& to, const std::vector<ParsedParam>& more) const {
  ParsedPlugin plugin{std::string(to.name), parsed_.where, more};
  for (const Param& p : to.params) {
    const auto declared = std::ranges::find(info_.params, p.name, &Param::name);
    if (declared == info_.params.end()) continue;
    if (const ParsedParam* parsed = find(p.name).parsed) plugin.params.push_back(*parsed);
  }
  return {to, plugin, resolver_};
}

Location Params::where(std::string_view name) const {
  for (const ParsedParam& p : parsed_.params)
    if (p.name == name) return p.value_where;
  return parsed_.where;
}

std::vector<std::string_view> Params::unread() const {
  std::vector<std::string_view> names;
  for (size_t i = 0; i < read_.size(); ++i)
    if (!read_[i]) names.push_back(info_.params[i].name);
  return names;
}

bool Params::boolean(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  return parsed ? bool(std::get<std::vector<bool>>(parsed->values)[0]) : value_by_default<bool>(info_, declared);
}

int Params::integer(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  return parsed ? static_cast<int>(number_values(*parsed)[0]) : value_by_default<int>(info_, declared);
}

double Params::real(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  return parsed ? number_values(*parsed)[0] : number_by_default(info_, declared);
}

std::string Params::string(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  return parsed ? string_values(*parsed)[0] : std::string(value_by_default<std::string_view>(info_, declared));
}

Vec2 Params::vec2(std::string_view name) const {
  const auto v = reals(name);
  return {static_cast<float>(v[0]), static_cast<float>(v[1])};
}

Vec3 Params::vec3(std::string_view name) const { return vec3_at(reals(name), 0); }

std::vector<double> Params::reals(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  if (parsed) return number_values(*parsed);
  if (const auto* v = std::get_if<std::array<double, 3>>(&declared.default_value)) return {v->begin(), v->end()};
  return {};
}

std::vector<int> Params::integers(std::string_view name) const {
  const auto v = reals(name);
  std::vector<int> result;
  result.reserve(v.size());
  for (const double x : v) result.push_back(static_cast<int>(x));
  return result;
}

std::string Params::color_space(std::string_view name) const {
  const ParsedParam* parsed = find(name).parsed;
  return parsed ? parsed->color_space : std::string();
}

std::vector<std::string> Params::strings(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  return parsed ? string_values(*parsed) : std::vector<std::string>();
}

std::vector<Vec2> Params::vec2s(std::string_view name) const {
  const auto v = reals(name);
  std::vector<Vec2> result;
  result.reserve(v.size() / 2);
  for (size_t i = 0; i + 1 < v.size(); i += 2)
    result.push_back({static_cast<float>(v[i]), static_cast<float>(v[i + 1])});
  return result;
}

std::vector<Vec3> Params::vec3s(std::string_view name) const {
  const auto v = reals(name);
  std::vector<Vec3> result;
  result.reserve(v.size() / 3);
  for (size_t i = 0; i + 2 < v.size(); i += 3) result.push_back(vec3_at(v, i));
  return result;
}

SpectrumPtr Params::spectrum(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  const SpectrumUse use = declared.kind == ParamKind::illuminant  ? SpectrumUse::illuminant
                          : declared.kind == ParamKind::unbounded ? SpectrumUse::unbounded
                                                                  : SpectrumUse::albedo;
  if (parsed) return resolver_.spectrum(*parsed, use);
  return resolver_.spectrum(default_spectrum(info_, declared, parsed_.where), use);
}

namespace {

class ClampedFloatTexture final : public FloatTexture {
 public:
  ClampedFloatTexture(std::shared_ptr<const FloatTexture> texture, Interval range)
      : texture_(std::move(texture)), range_(range) {}
  float evaluate(const TexturePoint& at) const override {
    return std::clamp(texture_->evaluate(at), float(range_.min), float(range_.max));
  }
  Interval range() const override {
    const Interval own = texture_->range();
    return {std::clamp(own.min, range_.min, range_.max), std::clamp(own.max, range_.min, range_.max)};
  }
  bool is_range_tight() const override { return texture_->is_range_tight(); }
  bool needs_details() const override { return texture_->needs_details(); }

 private:
  std::shared_ptr<const FloatTexture> texture_;
  Interval range_;
};

std::shared_ptr<const FloatTexture> texture_in_range(ParamResolver& resolver, const Param& declared,
                                                     const std::string& name, const Location& where) {
  auto texture = resolver.float_texture(name, where);
  const Interval values = texture->range(), range = declared.range;
  if (range.contains(values.min) && range.contains(values.max)) {
    const std::string hint = unit_hint(values.max, declared.quantity, declared.unit, range);
    if (texture->is_range_tight() && !hint.empty())
      resolver.warn(where, fmt::format("texture \"{}\" has values up to {:.3g}{}{} for \"{}\": {}", name, values.max,
                                       declared.unit.empty() ? "" : " ", declared.unit, declared.name, hint));
    return texture;
  }
  const std::string message = fmt::format(
      "texture \"{}\" has values from {:.3g} to {:.3g}, outside the range {} to {}{}{} of \"{}\"", name, values.min,
      values.max, range.min, range.max, declared.unit.empty() ? "" : " ", declared.unit, declared.name);
  // With a unit, values out of range are most likely given in another unit: that is an error. Bounds that are not
  // tight, such as the bounds of noise, do not indicate a wrong unit.
  if ((!declared.unit.empty() && texture->is_range_tight()) || values.max < range.min || values.min > range.max ||
      !(values.min <= values.max))
    fail(where, "{}", message);
  if (texture->is_range_tight()) resolver.warn(where, message + ": they are clamped");
  return std::make_shared<ClampedFloatTexture>(std::move(texture), range);
}

}  // namespace

std::shared_ptr<const FloatTexture> Params::float_texture(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  if (is_texture(name)) return texture_in_range(resolver_, declared, string_values(*parsed)[0], parsed->value_where);
  const double value = parsed ? number_values(*parsed)[0] : number_by_default(info_, declared);
  return std::make_shared<ConstantFloatTexture>(static_cast<float>(value));
}

std::vector<std::shared_ptr<const FloatTexture>> Params::float_textures(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  std::vector<std::shared_ptr<const FloatTexture>> result;
  if (is_texture(name))
    for (const std::string& word : string_values(*parsed))
      result.push_back(texture_in_range(resolver_, declared, word, parsed->value_where));
  else if (parsed)
    for (const double x : number_values(*parsed)) result.push_back(std::make_shared<ConstantFloatTexture>(float(x)));
  return result;
}

bool Params::is_texture(std::string_view name) const {
  const ParsedParam* parsed = find(name).parsed;
  return parsed && parsed->type == "texture";
}

std::shared_ptr<const SpectrumTexture> Params::spectrum_texture(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  if (parsed && parsed->type == "texture")
    return resolver_.spectrum_texture(string_values(*parsed)[0], parsed->value_where);
  const ParsedParam& value = parsed ? *parsed : default_spectrum(info_, declared, parsed_.where);
  // Coefficients have a range without an upper end. The values of textures are at most 1 all the same.
  const bool is_share = std::isfinite(declared.range.max) || declared.range.min != 0;
  return std::make_shared<ConstantSpectrumTexture>(
      resolver_.spectrum(value, is_share ? SpectrumUse::albedo : SpectrumUse::unbounded));
}

std::filesystem::path Params::file(std::string_view name) const { return resolver_.file(string(name), where(name)); }

std::vector<std::filesystem::path> Params::files(std::string_view name) const {
  std::vector<std::filesystem::path> result;
  for (const std::string& file : strings(name)) result.push_back(resolver_.file(file, where(name)));
  return result;
}

std::vector<std::shared_ptr<Material>> Params::materials(std::string_view name) const {
  const auto [declared, parsed] = find(name);
  std::vector<std::shared_ptr<Material>> result;
  if (parsed)
    for (const std::string& material : string_values(*parsed))
      result.push_back(resolver_.material(material, parsed->value_where));
  return result;
}

}  // namespace frond
