#include "radiometry/radiometer_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/bssrdf.h"
#include "core/fluorescence.h"
#include "core/log.h"
#include "scene/format/plugin_text.h"
#include "scene/geometry/shape_emitter.h"
#include "scene/geometry_builder.h"
#include "scene/scene_options.h"

namespace frond {
namespace {

/// Whether paths end by their attenuation, without roulette.
bool ends_by_attenuation(const ParsedPlugin& integrator) {
  const ParsedParam* termination = find_param(integrator.params, "termination");
  const auto* words = termination ? std::get_if<std::vector<std::string>>(&termination->values) : nullptr;
  return words && *words == std::vector<std::string>{"attenuation"};
}

/// Whether the model's parameter "incident" accepts "reciprocal".
bool can_be_reciprocal(const PluginInfo& info) {
  const Param* incident = find_param(info, "incident");
  return incident && std::ranges::count(incident->choices, std::string_view("reciprocal")) > 0;
}

/// Returns the material's model; for `leaf` the model that it selects.
std::string_view model_of(const ParsedPlugin& plugin) {
  const ParsedParam* model = find_param(plugin.params, "model");
  const auto* words = model ? std::get_if<std::vector<std::string>>(&model->values) : nullptr;
  if (words && words->size() == 1) return words->front();
  return plugin.name;
}

struct FileBounds {
  Vec3d min, max;
};

/// Returns bounds in the coordinates of the scene file.
FileBounds in_file(const Bounds& b, const Scene& scene) {
  return {to_double(b.min) + scene.origin(), to_double(b.max) + scene.origin()};
}

/// Returns the scene's bounds in the coordinates of the scene file.
FileBounds file_bounds(const Scene& scene) { return in_file(scene.geometry().bounds(), scene); }

double horizontal_area(const Bounds& b) { return double(b.max.x - b.min.x) * double(b.max.y - b.min.y); }

/// Index of the largest surface by horizontal extent, if it is flat; nullopt if it is not, or if there is none.
std::optional<size_t> largest_flat_surface(const Geometry& geometry) {
  std::optional<size_t> largest;
  double area = 0;
  for (size_t i = 0; i < geometry.surfaces().size(); ++i)
    if (const double own = horizontal_area(geometry.bounds_of(i)); own > area) largest = i, area = own;
  if (!largest) return {};
  constexpr float kFlat = 0.05f;  // height over width: with the relief of a field
  const Bounds b = geometry.bounds_of(*largest);
  return b.max.z - b.min.z <= kFlat * std::max(b.max.x - b.min.x, b.max.y - b.min.y) ? largest : std::nullopt;
}

/// Returns bounds with few digits, which contain the given ones.
FileBounds rounded_outward(const FileBounds& b) {
  const double size = std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
  const double per_unit = std::pow(10, 4 - std::floor(std::log10(size)));  // steps of 1e-4 of the size
  const auto down = [per_unit](double x) { return std::floor(x * per_unit) / per_unit; };
  const auto up = [per_unit](double x) { return std::ceil(x * per_unit) / per_unit; };
  return {{down(b.min.x), down(b.min.y), down(b.min.z)}, {up(b.max.x), up(b.max.y), up(b.max.z)}};
}

/// Warns if all but the ground covers less than half of the target, which is the whole scene.
void warn_about_empty_ground(const Scene& scene, const Target& target, const Log& log) {
  constexpr double kMostly = 0.5;
  const Geometry& geometry = scene.geometry();
  const auto ground = largest_flat_surface(geometry);
  if (!ground) return;
  const Bounds rest = geometry.bounds_without(*ground);
  if (rest.is_empty() || geometry.bounds_of(*ground).max.z > rest.max.z) return;
  const double share = horizontal_area(rest) / ((target.x1 - target.x0) * (target.y1 - target.y0));
  if (!(share > 0 && share < kMostly)) return;
  const FileBounds better = rounded_outward(in_file(rest, scene));
  log.warn({}, fmt::format("the target is the whole scene, by default, and all but the ground covers {:.2g} % of it: "
                           "--target {:.12g},{:.12g},{:.12g},{:.12g},{:.12g} measures that",
                           100 * share, better.min.x, better.max.x, better.min.y, better.max.y, better.max.z));
}

}  // namespace

void keep_energy(SceneDescription& description, const Registry& registry) {
  for (MaterialDescription& m : description.materials) {
    const MaterialInfo& info = registry.materials.get(m.plugin.name, m.plugin.where);
    if (!find_param(info, "incident") || find_param(m.plugin.params, "incident")) continue;
    const MaterialInfo* model = registry.materials.find(model_of(m.plugin));
    const std::string word = can_be_reciprocal(info) && (!model || can_be_reciprocal(*model)) ? "reciprocal" : "light";
    m.plugin.params.push_back({"string", "incident", {}, {}, std::vector<std::string>{word}});
  }
}

void prepare_for_radiometry(const Registry& registry, const std::string& wavelengths,
                            const std::optional<std::array<double, 2>>& period, bool keeps_depth,
                            SceneDescription& description, bool fluorescence) {
  constexpr double kDeepest = 1 << 20;
  keep_energy(description, registry);
  if (!wavelengths.empty())
    set_wavelengths(description, wavelengths, {std::make_shared<const std::string>("wavelengths")});
  const auto strategy = make_wavelengths(description, registry);
  if (!fluorescence && std::ranges::any_of(strategy->bands(), is_of_fluorescence))
    fail(wavelengths_plugin(description, registry).where,
         "bands of fluorescence have no reflectance: brf and flux measure them with --fluorescence");
  if (strategy->bands().empty()) {
    const ParsedPlugin plugin = wavelengths_plugin(description, registry);
    fail(plugin.where, "\"{}\" is for images of colours: a measurement needs bands, as in 608,551,455 or 400:700:10",
         plugin.name);
  }
  if (period) set_param(description.options, parsed_numbers("float", "period", {(*period)[0], (*period)[1]}));
  ParsedPlugin& integrator = description.integrator;
  const IntegratorInfo& info = registry.integrators.get(integrator.name, integrator.where);
  if (!keeps_depth && find_param(info, "maxdepth"))
    set_param(integrator.params, parsed_numbers("integer", "maxdepth", {kDeepest}));
  // A target varies more from place to place than a pixel does, so a second ray from the same place does not pay.
  if (find_param(info, "scatteredrays") && !find_param(integrator.params, "scatteredrays"))
    set_param(integrator.params, parsed_numbers("integer", "scatteredrays", {1}));
  // In the light of suns alone this suits canopies of bright and of dark leaves. Under a sky the first scattered rays
  // find most of the light.
  const bool has_only_suns = std::ranges::all_of(
      description.lights, [](const LightDescription& light) { return light.plugin.name == "distant"; });
  if (has_only_suns && find_param(info, "roulette") && !find_param(integrator.params, "roulette") &&
      !ends_by_attenuation(integrator))
    set_param(integrator.params, parsed_numbers("float", "roulette", {2}));
}

const ParsedPlugin* light_without_unit(const SceneDescription& description) {
  const auto has_unit = [](const ParsedPlugin& light) {
    if (light.name == "sky") return !find_param(light.params, "illuminance");
    return find_param(light.params, "radiantpower") || find_param(light.params, "photonflux");
  };
  for (const auto& [light, _] : description.lights)
    if (!has_unit(light)) return &light;
  for (const ParsedPlugin& light : description.area_lights)
    if (!has_unit(light)) return &light;
  return nullptr;
}

std::string measurement_text(const std::string& what, const std::optional<Target>& target,
                             const std::optional<std::array<double, 2>>& period) {
  std::string text = what;
  if (target) text += fmt::format(" target {},{},{},{},{}", target->x0, target->x1, target->y0, target->y1, target->z);
  if (period) text += fmt::format(" period {},{}", (*period)[0], (*period)[1]);
  return text;
}

Target default_target(const Scene& scene, const Log& log) {
  if (scene.geometry().bounds().is_empty()) fail({}, "nothing stands in this scene: there is nothing to look at");
  const FileBounds b = file_bounds(scene);
  Target target{b.min.x, b.max.x, b.min.y, b.max.y, b.max.z};
  if (const auto period = scene.period()) {
    target.x1 = target.x0 + double(period->x);
    target.y1 = target.y0 + double(period->y);
  }
  if (!(target.x0 < target.x1 && target.y0 < target.y1))
    fail({}, "the scene has no horizontal extent: give --target x0,x1,y0,y1,z");
  if (!scene.period()) warn_about_empty_ground(scene, target, log);
  return target;
}

void check_target(const Scene& scene, const Target& target) {
  const auto b = file_bounds(scene);
  for (const double z : {target.z, b.max.z}) {
    check_coordinates({float(target.x0), float(target.y0), float(z)}, "a corner of the target is", {});
    check_coordinates({float(target.x1), float(target.y1), float(z)}, "a corner of the target is", {});
  }
  const bool is_beside = target.x1 <= b.min.x || target.x0 >= b.max.x || target.y1 <= b.min.y || target.y0 >= b.max.y;
  if (is_beside && !scene.period())
    fail({}, "the target lies beside the scene, which reaches from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})", b.min.x,
         b.min.y, b.max.x, b.max.y);
}

void refuse_subsurface(const LoadedScene& loaded) {
  const auto& materials = loaded.description().materials;
  for (size_t i = 0; i < materials.size(); ++i)
    if (dynamic_cast<const SubsurfaceMaterial*>(loaded.scene().material(i)))
      fail(materials[i].plugin.where,
           "flux does not follow light under the surface of material \"{}\"; brf and render do",
           materials[i].plugin.name);
}

std::vector<uint32_t> reflectors_of(const Scene& scene) {
  const SampledWavelengths lambda = scene.wavelengths().sample(0.5f);
  const Hit hit{.p = {}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}, {}}};
  std::vector<uint32_t> materials = scene.geometry().materials();
  std::erase_if(materials, [&](uint32_t m) {
    Arena arena;
    return !scene.material(m) || !scene.material(m)->evaluate(hit, lambda, arena);
  });
  return materials;
}

std::vector<double> areas_of_materials(const Geometry& geometry, size_t materials) {
  std::vector<double> areas(materials);
  geometry.visit_surfaces([&](const Surface& surface, const AffineMap&, uint64_t instance) {
    areas[surface.material] += instance > 0 ? std::numeric_limits<double>::quiet_NaN() : ShapeEmitter(surface).area();
  });
  return areas;
}

double bottom_of(const Scene& scene) { return file_bounds(scene).min.z; }

double distance_above(const Scene& scene, const Target& target, double cosine) {
  constexpr double kClear = 1e-3;  // fraction of the scene's radius
  const double top = file_bounds(scene).max.z + kClear * double(scene.radius());
  return std::max(0.0, top - target.z) / cosine;
}

}  // namespace frond
