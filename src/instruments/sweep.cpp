#include "instruments/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/texture.h"

namespace frond {
namespace {

/// The range with infinite ends replaced by `far`.
Interval finite_range(const Interval& range, double far) {
  return {std::max(range.min, -far), std::min(range.max, far)};
}

/// Range whose ends are swept.
Interval swept_range(const Param& p) { return finite_range(p.range, 1000); }

/// Range from which points inside are drawn.
Interval interior_range(const Param& p) {
  const auto* value = std::get_if<double>(&p.default_value);
  return finite_range(p.range, std::max({1.0, value ? 2 * std::abs(*value) : 0.0, p.range.min, -p.range.max}));
}

ParsedParam make_param(const Param& p, std::string type, decltype(ParsedParam::values) values) {
  ParsedParam result;
  result.type = std::move(type);
  result.name = p.name;
  result.values = std::move(values);
  return result;
}

/// A spectrum at the fraction u of the range; by default of 0 to 1.
ParsedParam constant_spectrum(const Param& p, double u) {
  const Interval range{std::max(p.range.min, 0.0), std::min(p.range.max, 1.0)};
  const double value = std::lerp(range.min, range.max, std::clamp(u, 0.0, 1.0));
  return make_param(p, "spectrum", std::vector<double>{360, value, 2500, value});
}

/// Discrete values of a parameter: booleans, choices. Empty for others.
std::vector<ParsedParam> choices(const Param& p) {
  std::vector<ParsedParam> result;
  if (p.kind == ParamKind::boolean)
    for (const bool b : {false, true}) result.push_back(make_param(p, "bool", std::vector<bool>{b}));
  for (const std::string_view word : p.choices)
    result.push_back(make_param(p, "string", std::vector<std::string>{std::string(word)}));
  return result;
}

/// Value at the fraction u in [0, 1] of a range; nothing if the kind has no range.
std::vector<ParsedParam> at(const Param& p, const Interval& range, double u) {
  const double x = std::lerp(range.min, range.max, u);
  const auto vector_of = [&](std::string type, size_t n) {
    return std::vector{make_param(p, std::move(type), std::vector<double>(n, x))};
  };
  switch (p.kind) {
    case ParamKind::integer:
      return {make_param(p, "integer", std::vector<double>{std::round(x)})};
    case ParamKind::real:
    case ParamKind::float_texture:
      return vector_of("float", 1);
    case ParamKind::point2:
      return vector_of("point2", 2);
    case ParamKind::vector2:
      return vector_of("vector2", 2);
    case ParamKind::point3:
      return vector_of("point3", 3);
    case ParamKind::vector3:
      return vector_of("vector3", 3);
    case ParamKind::normal3:
      return vector_of("normal", 3);
    case ParamKind::illuminant:
    case ParamKind::albedo:
    case ParamKind::spectrum_texture:
    case ParamKind::unbounded:
      return {constant_spectrum(p, u)};
    default:
      return {};
  }
}

bool is_share(const Param& p) { return p.kind == ParamKind::albedo || p.kind == ParamKind::spectrum_texture; }

/// Whether a sweep varies the parameter to this end of its range, 0 or 1.
bool is_swept_to(const Param& p, double end, const SweepOptions& options) {
  if (at(p, interior_range(p), 0.5).empty()) return false;
  return options.infinite_ends || is_share(p) || std::isfinite(end == 0 ? p.range.min : p.range.max);
}

/// Value of a required parameter without a default and without a pinned value.
ParsedParam placeholder_value(const Param& p) {
  if (const auto options = choices(p); !options.empty()) return options.front();
  if (p.kind == ParamKind::material && p.list) return make_param(p, "string", std::vector<std::string>{"one", "other"});
  if (const auto values = at(p, interior_range(p), 0.5); !values.empty()) return values.front();
  return make_param(p, "string", std::vector<std::string>{"one"});
}

std::string text(const ParsedParam& p) {
  // A spectrum of `constant_spectrum`, wavelengths and values in turn, by its one value.
  if (p.type == "spectrum") return fmt::format("{} = {}", p.name, std::get<std::vector<double>>(p.values)[1]);
  return std::visit([&](const auto& values) { return fmt::format("{} = {}", p.name, fmt::join(values, " ")); },
                    p.values);
}

class Sweep {
 public:
  Sweep(const PluginInfo& info, const SweepOptions& options) : info_(info), numbers_(options.seed) {
    for (const Param& p : info.params) {
      const auto pinned = std::ranges::find(options.pinned, p.name, &ParsedParam::name);
      if (pinned != options.pinned.end())
        always_.push_back(*pinned);
      else if (!p.in_place_of_others)
        swept_.push_back(&p);
    }
  }

  std::vector<ParameterSet> run(const SweepOptions& options) {
    add("defaults", {});
    for (const Param* p : swept_) {
      for (const ParsedParam& choice : choices(*p)) add(text(choice), {choice});
      for (const double end : {0.0, 1.0})
        if (is_swept_to(*p, end, options))
          for (const ParsedParam& value : at(*p, swept_range(*p), end)) add(text(value), {value});
    }
    for (int i = 0; i < options.random_corners; ++i)
      add_random(fmt::format("corner {}", i), swept_range, [this] { return numbers_.uniform() < 0.5f ? 0.0 : 1.0; });
    for (int i = 0; i < options.random_points; ++i)
      add_random(fmt::format("point {}", i), interior_range, [this] { return numbers_.uniform_double(); });
    return std::move(sets_);
  }

 private:
  void add(std::string label, std::vector<ParsedParam> values) {
    for (const Param* p : swept_)
      if (p->required && std::ranges::find(values, p->name, &ParsedParam::name) == values.end())
        values.push_back(placeholder_value(*p));
    values.insert(values.end(), always_.begin(), always_.end());
    sets_.push_back({std::move(label), {std::string(info_.name), {}, std::move(values)}});
  }

  void add_random(const std::string& label, Interval (*range)(const Param&), const std::function<double()>& place) {
    std::vector<ParsedParam> values;
    for (const Param* p : swept_) {
      const auto options = choices(*p);
      if (options.empty())
        for (ParsedParam& value : at(*p, range(*p), place())) values.push_back(std::move(value));
      else
        values.push_back(options[numbers_.bits() % options.size()]);
    }
    std::string all = label;
    for (const ParsedParam& value : values) all += ", " + text(value);
    add(all, std::move(values));
  }

  const PluginInfo& info_;
  RandomStream numbers_;
  std::vector<ParsedParam> always_;
  std::vector<const Param*> swept_;
  std::vector<ParameterSet> sets_;
};

/// Numbers in pairs of wavelength (nm) and value, linear in between.
class GivenSpectrum final : public Spectrum {
 public:
  explicit GivenSpectrum(std::vector<double> pairs) : pairs_(std::move(pairs)) {}

  float at(float lambda_nm) const override {
    for (size_t i = 2; i < pairs_.size(); i += 2)
      if (lambda_nm <= pairs_[i]) {
        const double t = std::clamp((lambda_nm - pairs_[i - 2]) / (pairs_[i] - pairs_[i - 2]), 0.0, 1.0);
        return static_cast<float>(std::lerp(pairs_[i - 1], pairs_[i + 1], t));
      }
    return static_cast<float>(pairs_.back());
  }
  Interval range_nm() const override { return {pairs_[0], pairs_[pairs_.size() - 2]}; }
  float max_value() const override {
    double highest = pairs_[1];
    for (size_t i = 3; i < pairs_.size(); i += 2) highest = std::max(highest, pairs_[i]);
    return static_cast<float>(highest);
  }

 private:
  std::vector<double> pairs_;
};

}  // namespace

std::vector<ParameterSet> parameter_sweep(const PluginInfo& info, const SweepOptions& options) {
  return Sweep(info, options).run(options);
}

SweptParams swept_params(const PluginInfo& info, const SweepOptions& options) {
  SweptParams result;
  for (const Param& p : info.params) {
    if (std::ranges::find(options.pinned, p.name, &ParsedParam::name) != options.pinned.end()) continue;
    const bool is_swept = !p.in_place_of_others;
    const bool low = is_swept && is_swept_to(p, 0, options), high = is_swept && is_swept_to(p, 1, options),
               chosen = is_swept && !choices(p).empty();
    const std::string name(p.name);
    if (low || high || chosen) result.varied.push_back(name);
    if (!chosen && !(low && high))
      result.unvaried.push_back(low ? name + " (no upper end)" : high ? name + " (no lower end)" : name);
  }
  return result;
}

std::shared_ptr<const FloatTexture> PlainResolver::float_texture(const std::string& name, const Location& where) {
  fail(where, "there is no texture \"{}\"", name);
}

std::shared_ptr<const SpectrumTexture> PlainResolver::spectrum_texture(const std::string& name, const Location& where) {
  fail(where, "there is no texture \"{}\"", name);
}

SpectrumPtr PlainResolver::spectrum(const ParsedParam& param, SpectrumUse) {
  const auto* numbers = std::get_if<std::vector<double>>(&param.values);
  if (!numbers || numbers->empty()) fail(param.value_where, "\"{}\" needs numbers here", param.name);
  if (param.type == "spectrum" && numbers->size() % 2 == 0) return std::make_shared<GivenSpectrum>(*numbers);
  double sum = 0;
  for (const double x : *numbers) sum += x;
  const double mean = sum / static_cast<double>(numbers->size());
  return std::make_shared<GivenSpectrum>(std::vector<double>{0, mean, 1e6, mean});
}

}  // namespace frond
