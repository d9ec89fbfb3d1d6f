#include "scene/pbrt_plugins.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>

#include "scene/format/plugin_text.h"
#include "textures/normal_map.h"

namespace frond {
namespace {

/// Replacement of a plug-in of pbrt-v4. Parameters that the replacement declares are kept; other parameters of pbrt are
/// dropped.
struct StandIn {
  std::string_view name, ours;
  std::string_view feature;                   ///< kind for --ignore-unsupported; empty: the expected image is the same
  std::span<const std::string_view> of_pbrt;  ///< allowed parameters; empty: any
  std::string_view caution = {};
  bool replaces_ours = false;  ///< also if frond has a plug-in of this name
};

constexpr std::string_view kRandomized[] = {"pixelsamples", "seed", "randomization"};
constexpr std::string_view kPlain[] = {"pixelsamples", "seed"};
constexpr std::string_view kStratified[] = {"xsamples", "ysamples", "jitter", "seed"};
constexpr StandIn kPbrtSamplers[] = {
    {"zsobol", "lattice", "", kRandomized}, {"paddedsobol", "lattice", "", kRandomized},
    {"halton", "lattice", "", kRandomized}, {"sobol", "lattice", "", kRandomized},
    {"pmj02bn", "lattice", "", kPlain},     {"stratified", "lattice", "", kStratified}};

constexpr std::string_view kPath[] = {"maxdepth", "lightsampler", "regularize"};
constexpr std::string_view kSimplePath[] = {"maxdepth", "samplelights", "samplebsdf"};
constexpr std::string_view kRandomWalk[] = {"maxdepth"};
/// Integrators of pbrt-v4 that have the same expected image. In scenes with media volpath replaces them.
constexpr StandIn kIntegrators[] = {{"volpath", "path", "", kPath, "", true},
                                    {"simplepath", "path", "", kSimplePath},
                                    {"randomwalk", "path", "", kRandomWalk},
                                    {"simplevolpath", "path", "", kRandomWalk},
                                    {"lightpath", "path", "", {}},
                                    {"bdpt", "path", "", {}},
                                    {"mlt", "path", "", {}},
                                    {"sppm", "path", "", {}},
                                    {"ambientocclusion", "path", "", {}},
                                    {"function", "path", "", {}}};
/// Integrators that compute another image: their replacement causes a warning.
constexpr std::string_view kOtherImages[] = {"ambientocclusion", "function"};
constexpr StandIn kPbrtCameras[] = {{"realistic", "perspective", "cameras", {}, ", which lets in more light"}};
constexpr StandIn kTextures[] = {{"ptex", "constant", "textures", {}}};

/// Materials of pbrt-v3 and older.
constexpr std::string_view kOldMaterials[] = {"matte",     "plastic",    "uber",        "glass",   "mirror",
                                              "substrate", "metal",      "translucent", "fourier", "disney",
                                              "none",      "shinymetal", "kdsubsurface"};
constexpr std::string_view kOldSamplers[] = {"lowdiscrepancy", "random",        "02sequence", "(0,2)-sequence",
                                             "maxmindist",     "bestcandidate", "adaptive"};
constexpr std::string_view kOldIntegrators[] = {"directlighting",  "whitted",         "photonmap", "exphotonmap", "igi",
                                                "irradiancecache", "dipolesubsurface"};
constexpr std::string_view kOldCameras[] = {"environment"};
constexpr std::string_view kOldFilms[] = {"image"};
constexpr std::string_view kOldShapes[] = {"cone", "heightfield", "hyperboloid", "nurbs", "paraboloid"};
constexpr std::string_view kOldTextures[] = {"uv"};

/// Returns a numeric parameter; nullopt if it is not given. Throws InputError for several values.
std::optional<double> number(const ParsedPlugin& plugin, std::string_view name) {
  const ParsedParam* p = find_param(plugin.params, name);
  if (!p) return {};
  const auto* values = std::get_if<std::vector<double>>(&p->values);
  if (!values || values->size() != 1) fail(p->value_where, "\"{}\" takes 1 number", name);
  return (*values)[0];
}

/// Replaces the plug-ins of one description, kind by kind.
class PbrtTranslator {
 public:
  PbrtTranslator(const Unsupported& unsupported, const Log& log, Problems& problems)
      : unsupported_(unsupported), log_(log), problems_(problems) {}

  /// Returns whether the plug-in was replaced. Also true after an error, so that it is reported once.
  template <class Info>
  bool translate(std::string_view directive, const PluginTable<Info>& ours, std::span<const StandIn> stand_ins,
                 std::span<const std::string_view> old, ParsedPlugin& plugin) {
    if (!ours.find(plugin.name) && std::ranges::find(old, plugin.name) != old.end()) {
      reject_old(directive, plugin);
      plugin.name = ours.all().front()->name;
      plugin.params.clear();
      return false;
    }
    for (const StandIn& by : stand_ins) {
      if (by.name != plugin.name || !ours.find(by.ours)) continue;
      if (ours.find(by.name) && by.name != by.ours && !by.replaces_ours) continue;
      replace(directive, *ours.find(by.ours), by, plugin);
      return true;
    }
    return false;
  }

  /// Drops displacement, by which pbrt moves a mesh's vertices.
  void drop_displacement(ParsedPlugin& shape) {
    if (shape.name != "plymesh") return;
    if (const ParsedParam* p = find_param(shape.params, "displacement"))
      problems_.attempt([&] {
        unsupported_.handle("displacement", p->where, "\"displacement\" of shape \"plymesh\"", "is left out", log_);
      });
    std::erase_if(shape.params, [](const auto& p) { return p.name == "displacement" || p.name == "edgelength"; });
  }

  /// Only the first plug-in of an older version is reported: the remedy is the same for all.
  void reject_old(std::string_view directive, const ParsedPlugin& plugin) {
    if (!old_.empty()) return;
    old_.attempt([&] {
      fail(plugin.where,
           "{} \"{}\": this is a file for pbrt-v3 or older; \"pbrt --upgrade\" of pbrt-v4 makes one for pbrt-v4",
           directive, plugin.name);
    });
  }

  /// Errors that identify the file as written for an older version of pbrt.
  const Problems& old() const { return old_; }

 private:
  /// Replaces the plug-in, with a warning or a log message, and drops parameters that the replacement lacks.
  void replace(std::string_view directive, const PluginInfo& ours, const StandIn& by, ParsedPlugin& plugin) {
    if (!by.feature.empty())
      problems_.attempt([&] {
        unsupported_.handle(by.feature, plugin.where, fmt::format("{} \"{}\"", directive, plugin.name),
                            fmt::format("is replaced by \"{}\"{}", by.ours, by.caution), log_);
      });
    else if (by.name != by.ours)
      log_.info(fmt::format("{} \"{}\" is replaced by frond's \"{}\"", directive, by.name, by.ours));
    std::erase_if(plugin.params, [&](const ParsedParam& p) {
      const auto is_called_so = [&p](const Param& known) { return known.name == p.name; };
      if (std::ranges::any_of(ours.params, is_called_so)) return false;
      return by.of_pbrt.empty() || std::ranges::find(by.of_pbrt, p.name) != by.of_pbrt.end();
    });
    plugin.name = by.ours;
  }

  const Unsupported& unsupported_;
  const Log& log_;
  Problems& problems_;
  Problems old_;
};

/// Converts x times y strata to a number of samples.
void count_strata(ParsedPlugin& sampler) {
  const double x = number(sampler, "xsamples").value_or(4), y = number(sampler, "ysamples").value_or(4);
  const Location where =
      find_param(sampler.params, "xsamples") ? find_param(sampler.params, "xsamples")->value_where : sampler.where;
  sampler.params.push_back({"integer", "pixelsamples", where, where, std::vector<double>{x * y}});
}

/// Chooses volpath for scenes with media, which pbrt's integrators other than path and simplepath see; path for others.
void translate_integrator(const Registry& registry, PbrtTranslator& translator, const Log& log, SceneDescription& d) {
  ParsedPlugin& integrator = d.integrator;
  std::vector<StandIn> stand_ins(std::begin(kIntegrators), std::end(kIntegrators));
  if (d.has_media() && registry.integrators.find("volpath")) {
    if (!integrator.where.file) integrator.name = "volpath";
    for (StandIn& by : stand_ins)
      if (by.name != "simplepath" && by.name != "randomwalk") by.ours = "volpath";
  }
  const std::string name = integrator.name;
  if (translator.translate("Integrator", registry.integrators, stand_ins, kOldIntegrators, integrator) &&
      std::ranges::find(kOtherImages, name) != std::end(kOtherImages))
    log.warn(integrator.where,
             fmt::format("Integrator \"{}\" is replaced by \"{}\", whose image is another", name, integrator.name));
}

/// Collects parameter names without duplicates.
void add_params(std::span<const Param> params, std::vector<std::string_view>& names) {
  for (const Param& p : params)
    if (std::ranges::find(names, p.name) == names.end()) names.push_back(p.name);
}

/// Warns about attributes that no plug-in of their target accepts.
void warn_of_attributes(const SceneSettings& description, const Registry& r, const Log& log) {
  std::map<std::string_view, std::vector<std::string_view>> names;
  const auto add = [&names](std::string_view target, const auto& table) {
    for (const auto* info : table.all()) add_params(info->params, names[target]);
  };
  add("shape", r.shapes), add("light", r.lights), add("light", r.area_lights);
  add("medium", r.media), add("material", r.materials), add("texture", r.float_textures),
      add("texture", r.spectrum_textures);
  add_params(normal_bend_params.params, names["material"]);
  for (const auto& [key, where] : description.attributes) {
    const auto& [target, name] = key;
    if (std::ranges::find(names[target], name) != names[target].end()) continue;
    const std::string_view match = nearest(name, names[target]);
    log.warn(where, fmt::format("no {} has a parameter \"{}\"{}", target, name,
                                match.empty() ? "" : fmt::format("; did you mean \"{}\"?", match)));
  }
}

/// Sets the field of view of a 50 mm lens on the film; pbrt's field of view refers to the shorter side.
void set_field_of_view(ParsedPlugin& camera, const ParsedPlugin& film) {
  constexpr double kFocalLength = 50;  // mm
  const double diagonal = number(film, "diagonal").value_or(35), x = number(film, "xresolution").value_or(1280),
               y = number(film, "yresolution").value_or(720);
  const double shorter = diagonal * std::min(x, y) / std::hypot(x, y);
  if (!(shorter > 0)) return;
  const double degrees = 2 * std::atan(shorter / (2 * kFocalLength)) * 180 / std::numbers::pi;
  camera.params.push_back({"float", "fov", camera.where, camera.where, std::vector<double>{degrees}});
}

/// Replaces a texture by a constant: white for float, grey for spectrum.
void set_constant(TextureDescription& texture) {
  const bool is_real = texture.value == TextureDescription::Value::real;
  const Location& where = texture.plugin.where;
  texture.plugin.params.clear();
  texture.plugin.params.push_back({is_real ? "float" : "rgb", "value", where, where,
                                   is_real ? std::vector<double>{1} : std::vector<double>{0.5, 0.5, 0.5}});
}

}  // namespace

void translate_pbrt_plugins(SceneDescription& description, const Registry& registry, const Unsupported& unsupported,
                            const Log& log, Problems& problems) {
  warn_of_attributes(description, registry, log);
  PbrtTranslator translator(unsupported, log, problems);
  SceneDescription& d = description;
  problems.attempt([&] {
    if (d.sampler.name == "stratified" && !registry.samplers.find("stratified")) count_strata(d.sampler);
  });
  translator.translate("Sampler", registry.samplers, kPbrtSamplers, kOldSamplers, d.sampler);
  // Shadow rays of volpath pass through material "interface", shadow rays of path do not. volpath is pbrt's default.
  const bool sees_through_interfaces =
      !d.integrator.where.file || d.integrator.name == "volpath" || d.integrator.name == "simplevolpath";
  translate_integrator(registry, translator, log, d);
  const bool is_realistic = d.camera.name == "realistic";
  if (translator.translate("Camera", registry.cameras, kPbrtCameras, kOldCameras, d.camera) && is_realistic)
    problems.attempt([&] { set_field_of_view(d.camera, d.film); });
  translator.translate("Film", registry.films, {}, kOldFilms, d.film);
  for (MaterialDescription& m : d.materials)
    translator.translate("Material", registry.materials, {}, kOldMaterials, m.plugin);
  for (TextureDescription& t : d.textures) {
    const bool is_real = t.value == TextureDescription::Value::real;
    const bool is_answered =
        is_real ? translator.translate("Texture", registry.float_textures, kTextures, kOldTextures, t.plugin)
                : translator.translate("Texture", registry.spectrum_textures, kTextures, kOldTextures, t.plugin);
    if (is_answered) set_constant(t);
  }
  const auto answer_shapes = [&](std::vector<ShapeDescription>& shapes) {
    for (ShapeDescription& s : shapes) translator.drop_displacement(s.plugin);
    std::erase_if(shapes, [&](const ShapeDescription& s) {
      if (sees_through_interfaces && s.medium_interface == 0 && d.materials[s.material].plugin.name == "interface")
        return true;
      if (registry.shapes.find(s.plugin.name) || std::ranges::find(kOldShapes, s.plugin.name) == std::end(kOldShapes))
        return false;
      translator.reject_old("Shape", s.plugin);
      return true;
    });
  };
  answer_shapes(d.shapes);
  for (ObjectDescription& object : d.objects) answer_shapes(object.shapes);
  if (translator.old().empty()) return;
  problems = translator.old();  // other errors follow from the wrong version
  d = {};
}

}  // namespace frond
