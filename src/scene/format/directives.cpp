#include "scene/format/directives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "core/messages/excerpt.h"
#include "core/units/number.h"

namespace frond {
namespace {

using Kind = Token::Kind;

/// A directive that is being executed.
struct Directive {
  std::string_view name;
  Location where;
  DirectiveContext& context;

  Token quoted() const { return read_quoted(context.tokens, name); }
  std::string text(const Token& token) const { return context.tokens.text_of(token); }
  Location location(const Token& token) const { return context.tokens.where(token); }
  DescriptionBuilder& scene() { return context.scene; }

  /// Reads a plug-in's quoted name and its parameters.
  ParsedPlugin plugin() {
    const Token token = quoted();
    return {text(token), location(token), parameters()};
  }
  /// Reads parameters. As in pbrt, the last one of a name counts.
  std::vector<ParsedParam> parameters() {
    std::vector<ParsedParam> params = context.parameters.read(context.tokens);
    std::unordered_map<std::string_view, size_t> last;
    for (size_t i = 0; i < params.size(); ++i) last[params[i].name] = i;
    if (last.size() == params.size()) return params;
    std::vector<ParsedParam> kept;
    std::set<std::string, std::less<>> repeated;
    for (size_t i = 0; i < params.size(); ++i)
      if (last.at(params[i].name) != i) repeated.insert(params[i].name);
    for (size_t i = 0; i < params.size(); ++i) {
      if (last.at(params[i].name) != i) continue;
      if (repeated.contains(params[i].name))
        context.log.warn(params[i].where,
                         fmt::format("parameter \"{}\" is given twice: this one counts", params[i].name));
      kept.push_back(params[i]);
    }
    return kept;
  }
  template <size_t N>
  std::array<double, N> numbers() {
    std::array<double, N> values;
    for (double& value : values) value = number_at(context.tokens, context.tokens.next(), usage(N));
    return values;
  }
  /// Reads a bracket. Throws InputError, which states the syntax.
  void bracket(Kind kind) {
    const Token token = context.tokens.next();
    if (token.kind != kind) fail(location(token), "{} takes 16 numbers in brackets, {} was given", name, token.shown());
  }
  std::string usage(size_t count) const { return fmt::format("{} takes {} numbers", name, count); }
};

template <size_t N>
Vec3d vec3_at(const std::array<double, N>& v, size_t i) {
  return {v[i], v[i + 1], v[i + 2]};
}

void scale(Directive d) { d.scene().concat(SceneTransform::scale(vec3_at(d.numbers<3>(), 0)), d.name, d.where); }

/// A rotation by 0 about a zero axis is the identity, which some exporters write.
void rotate(Directive d) {
  const auto v = d.numbers<4>();
  const Vec3d axis = vec3_at(v, 1);
  if (to_float(axis) != Vec3{}) return d.scene().concat(SceneTransform::rotate(v[0], axis), d.name, d.where);
  if (v[0] != 0) fail(d.where, "Rotate about the axis 0 0 0");
}

void look_at(Directive d) {
  constexpr double kParallel = 1e-6;  // sine of the smallest angle between up and view, by float's resolution
  const auto v = d.numbers<9>();
  const Vec3d view{v[3] - v[0], v[4] - v[1], v[5] - v[2]}, up{v[6], v[7], v[8]};
  if (view == Vec3d{}) fail(d.where, "LookAt: eye and target are the same point");
  if (up == Vec3d{}) fail(d.where, "LookAt: up is 0 0 0");
  if (!(length(cross(normalize(view), normalize(up))) > kParallel))
    fail(d.where, "LookAt: up is parallel to the direction of view");
  d.scene().concat(SceneTransform::look_at(vec3_at(v, 0), vec3_at(v, 3), vec3_at(v, 6)), d.name, d.where);
}

/// Reads 16 numbers in brackets, in column-major order.
SceneTransform matrix(Directive& d) {
  d.bracket(Kind::open_bracket);
  const auto m = d.numbers<16>();
  d.bracket(Kind::close_bracket);
  constexpr double kRounding = 1e-6;
  const double w = m[15], projective = std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11])});
  if (!(projective <= kRounding * std::abs(w)) || w == 0)
    fail(d.where, "{}: the matrix is projective (its last row is {} {} {} {}, not 0 0 0 1)", d.name, m[3], m[7], m[11],
         w);
  if (projective > 0)
    d.context.log.warn(
        d.where, fmt::format("{}: the last row {} {} {} {} is taken for 0 0 0 {}", d.name, m[3], m[7], m[11], w, w));
  Transform::RowsDouble rows;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) rows[i][j] = m[4 * j + i] / w;
  return SceneTransform(PreciseTransform(rows));
}

/// Texture "name" "float|spectrum" "class" parameters.
void texture(Directive d) {
  const Token name = d.quoted(), value = d.quoted();
  d.scene().texture({d.text(name), d.location(name)}, {d.text(value), d.location(value)}, d.plugin());
}

/// The quoted string is the material's name; its class is parameter "string type".
void make_named_material(Directive d) {
  ParsedPlugin plugin = d.plugin();
  const std::string name = plugin.name;
  d.scene().make_named_material(name, std::move(plugin));
}

/// Attribute "target" parameters.
void attribute(Directive d) {
  const Token target = d.quoted();
  d.scene().attribute(d.text(target), d.location(target), d.parameters());
}

void option(Directive d) { d.scene().option(d.context.parameters.read_option(d.context.tokens)); }

/// Accelerators are ignored: Embree builds its own. An unknown one is a warning.
void accelerator(Directive d) {
  constexpr std::string_view kOfPbrt[] = {"bvh", "kdtree"};
  const ParsedPlugin plugin = d.plugin();
  if (std::ranges::find(kOfPbrt, plugin.name) == std::end(kOfPbrt))
    d.context.log.warn(plugin.where, fmt::format("unknown accelerator \"{}\": Embree brings its own", plugin.name));
}

/// A single name applies to both sides.
void medium_interface(Directive d) {
  const auto name = [&d] {
    const Token token = d.quoted();
    return Quoted{d.text(token), d.location(token)};
  };
  const Quoted inside = name();
  d.scene().medium_interface(inside, d.context.tokens.peek().kind == Kind::string ? name() : inside);
}

void make_named_medium(Directive d) {
  ParsedPlugin plugin = d.plugin();
  const std::string name = plugin.name;
  if (name.empty()) fail(plugin.where, "MakeNamedMedium needs a name that is not empty");
  d.scene().make_named_medium(name, std::move(plugin));
}

void active_transform(Directive d) {
  constexpr std::array<std::string_view, 3> kNames{"All", "StartTime", "EndTime"};  // as in ActiveTransforms
  const Token which = d.context.tokens.next();
  const auto found = std::ranges::find(kNames, which.text);
  if (which.kind != Kind::word || found == kNames.end())
    fail(d.location(which), "ActiveTransform takes StartTime, EndTime or All, {} was given", which.shown());
  d.scene().activate_transforms(ActiveTransforms(found - kNames.begin()));
}

void transform_times(Directive d) {
  const auto [start, end] = d.numbers<2>();
  d.scene().transform_times(start, end, d.where);
}

template <ParsedPlugin SceneSettings::*option>
void option_plugin(Directive d) {
  d.scene().set_option_plugin(option, d.name, d.plugin());
}

/// Functions for directives that take one name, one plug-in, or nothing.
template <void (DescriptionBuilder::*act)(const std::string&, const Location&)>
void with_name(Directive d) {
  const Token name = d.quoted();
  (d.scene().*act)(d.text(name), d.location(name));
}
template <void (DescriptionBuilder::*act)(ParsedPlugin)>
void with_plugin(Directive d) {
  (d.scene().*act)(d.plugin());
}
template <void (DescriptionBuilder::*act)(const Location&)>
void without_arguments(Directive d) {
  (d.scene().*act)(d.where);
}

enum class Block : uint8_t { options, world, any };

/// A directive, the block that it is allowed in, and its function.
struct DirectiveEntry {
  std::string_view name;
  Block block;
  void (*execute)(Directive);
};

using Builder = DescriptionBuilder;

constexpr DirectiveEntry kDirectives[] = {
    {"Accelerator", Block::options, accelerator},
    {"ActiveTransform", Block::any, active_transform},
    {"AreaLightSource", Block::world, with_plugin<&Builder::area_light>},
    {"Attribute", Block::any, attribute},
    {"AttributeBegin", Block::world, without_arguments<&Builder::attribute_begin>},
    {"AttributeEnd", Block::world, without_arguments<&Builder::attribute_end>},
    {"Camera", Block::options, with_plugin<&Builder::camera>},
    {"ColorSpace", Block::any, with_name<&Builder::color_space>},
    {"ConcatTransform", Block::any, [](Directive d) { d.scene().concat(matrix(d), d.name, d.where); }},
    {"CoordSysTransform", Block::any, with_name<&Builder::recall_transform>},
    {"CoordinateSystem", Block::any, with_name<&Builder::name_transform>},
    {"Film", Block::options, with_plugin<&Builder::film>},
    {"Identity", Block::any, [](Directive d) { d.scene().set_transform(SceneTransform(), d.name, d.where); }},
    {"Integrator", Block::options, option_plugin<&SceneDescription::integrator>},
    {"LightSource", Block::world, with_plugin<&Builder::light>},
    {"LookAt", Block::any, look_at},
    {"MakeNamedMaterial", Block::world, make_named_material},
    {"MakeNamedMedium", Block::any, make_named_medium},
    {"Material", Block::world, with_plugin<&Builder::material>},
    {"MediumInterface", Block::any, medium_interface},
    {"NamedMaterial", Block::world, with_name<&Builder::named_material>},
    {"ObjectBegin", Block::world, with_name<&Builder::object_begin>},
    {"ObjectEnd", Block::world, without_arguments<&Builder::object_end>},
    {"ObjectInstance", Block::world, with_name<&Builder::object_instance>},
    {"Option", Block::any, option},
    {"PixelFilter", Block::options, option_plugin<&SceneDescription::filter>},
    {"ReverseOrientation", Block::world, [](Directive d) { d.scene().reverse_orientation(); }},
    {"Rotate", Block::any, rotate},
    {"Sampler", Block::options, option_plugin<&SceneDescription::sampler>},
    {"Scale", Block::any, scale},
    {"Shape", Block::world, with_plugin<&Builder::shape>},
    {"Texture", Block::world, texture},
    {"Transform", Block::any, [](Directive d) { d.scene().set_transform(matrix(d), d.name, d.where); }},
    {"TransformBegin", Block::world, without_arguments<&Builder::transform_begin>},
    {"TransformEnd", Block::world, without_arguments<&Builder::transform_end>},
    {"TransformTimes", Block::options, transform_times},
    {"Translate", Block::any,
     [](Directive d) { d.scene().concat(SceneTransform::translate(vec3_at(d.numbers<3>(), 0)), d.name, d.where); }},
    {"WorldBegin", Block::any, without_arguments<&Builder::world_begin>},
};

/// Directives of pbrt-v2. pbrt-v4's "pbrt --upgrade" reads files of pbrt-v3 only.
constexpr std::string_view kOfPbrt2[] = {"AreaLight",        "Exterior", "Interior",    "LightSourceBegin",
                                         "Renderer",         "Search",   "SearchPath",  "SurfaceIntegrator",
                                         "VolumeIntegrator", "Volume",   "VolumeRegion"};

/// Returns the directive that a word was probably meant to be, or an empty text.
std::string_view nearest_directive(const Token& word) {
  std::vector<std::string_view> names{"Include", "Import"};
  for (const DirectiveEntry& entry : kDirectives) names.push_back(entry.name);
  return nearest(word.text.substr(0, 80), names);
}

/// Recognizes files of older versions of pbrt, and numbers that follow a complete list.
[[noreturn]] void fail_unknown(const Token& token, const Location& where) {
  if (token.kind != Kind::word || parse_number(token.text))
    fail(where, "a directive is needed, {} was given", token.shown());
  if (token.text == "WorldEnd")
    fail(where, "WorldEnd: this is a file for pbrt-v3 or older; \"pbrt --upgrade\" of pbrt-v4 makes one for pbrt-v4");
  if (std::ranges::find(kOfPbrt2, token.text) != std::end(kOfPbrt2))
    fail(where,
         "{}: this is a file for pbrt-v2 or older; it has to become one for pbrt-v3 by hand (Integrator in place of "
         "SurfaceIntegrator and Renderer), then for pbrt-v4 by \"pbrt --upgrade\"",
         token.text);
  const std::string_view match = nearest_directive(token);
  if (match.empty()) fail(where, "unknown directive {}", token.shown());
  fail(where, "unknown directive {}; did you mean {}?", token.shown(), match);
}

/// Binary search: the table is sorted by name.
const DirectiveEntry* find_directive(const Token& token) {
  if (token.kind != Kind::word) return nullptr;
  const auto found =
      std::lower_bound(std::begin(kDirectives), std::end(kDirectives), token.text,
                       [](const DirectiveEntry& entry, std::string_view name) { return entry.name < name; });
  return found != std::end(kDirectives) && found->name == token.text ? found : nullptr;
}
static_assert(std::is_sorted(std::begin(kDirectives), std::end(kDirectives),
                             [](const DirectiveEntry& a, const DirectiveEntry& b) { return a.name < b.name; }));

}  // namespace

Token read_quoted(Tokenizer& tokens, std::string_view directive) {
  const Token token = tokens.next();
  if (token.kind != Kind::string)
    fail(tokens.where(token), "{} needs a quoted name, {} was given", directive, token.shown());
  return token;
}

bool is_directive(std::string_view word) {
  Token token;
  token.kind = Kind::word;
  token.text = word;
  return word == "Include" || word == "Import" || find_directive(token);
}

void check_begins_scene(const Token& first, const Location& where) {
  const bool is_old = first.text == "WorldEnd" || std::ranges::find(kOfPbrt2, first.text) != std::end(kOfPbrt2);
  if (first.kind == Kind::word && (is_old || is_directive(first.text) || !nearest_directive(first).empty())) return;
  constexpr size_t kMostShown = 8;
  fail(where, "this is no scene file: it begins with \"{}{}\", which is no directive",
       escaped(first.text.substr(0, kMostShown)), first.text.size() > kMostShown ? "..." : "");
}

/// Throws InputError for a directive in the wrong block.
void execute(const Token& name, DirectiveContext& context) {
  const Location where = context.tokens.where(name);
  const DirectiveEntry* entry = find_directive(name);
  if (!entry) fail_unknown(name, where);
  const bool in_world = context.scene.in_world();
  if (entry->block == Block::options && in_world) fail(where, "{} belongs before WorldBegin", entry->name);
  if (entry->block == Block::world && !in_world) {
    const std::string message = fmt::format("{} belongs after WorldBegin", entry->name);
    if (context.scene.is_incomplete()) throw Consequence(where, message);
    fail(where, "{}", message);
  }
  entry->execute({entry->name, where, context});
}

}  // namespace frond
