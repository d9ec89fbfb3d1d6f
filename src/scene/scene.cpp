#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/log.h"
#include "scene/resolver.h"

namespace frond {
namespace {

constexpr Param kOptionParams[] = {
    {.name = "seed",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2147483647},
     .doc = "Seed of all random numbers."},
    {.name = "wavelengths",
     .kind = ParamKind::string,
     .default_value = std::string_view("hero"),
     .doc = "Wavelength strategy."},
};
constexpr PluginInfo kOptions{"scene option", "Option", "Options of the whole render.", "", kOptionParams};

/// Binding of what can refer to files, but to nothing else of the scene.
class OptionResolver final : public ParamResolver {
 public:
  explicit OptionResolver(const SceneDescription& description) : description_(description) {}

 private:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<Material> material(const std::string&, const Location& w) override { none(w); }
  SpectrumPtr spectrum(const ParsedParam& p, bool) override { none(p.where); }
  std::filesystem::path file(const std::string& name, const Location& w) override {
    return description_.resolve(name, w);
  }
  [[noreturn]] static void none(const Location& where) { fail(where, "an option cannot refer to the scene"); }

  const SceneDescription& description_;
};

bool is_mixture(const MaterialInfo& info) {
  return std::any_of(info.params.begin(), info.params.end(),
                     [](const Param& p) { return p.kind == ParamKind::material; });
}

}  // namespace

/// Turns the description into a scene, in the order of what depends on what.
class SceneBuilder {
 public:
  SceneBuilder(Scene& scene, const SceneDescription& description, const Registry& registry,
               const SceneOverrides& overrides, ThreadPool& pool, const Log& log)
      : scene_(scene), description_(description), registry_(registry), overrides_(overrides), pool_(pool), log_(log) {}

  void build() {
    apply_swaps(description_, overrides_.swaps, registry_, log_);
    if (const auto& text = overrides_.integrator)
      override_plugin(*text, registry_.integrators.get(text->name, {}), {}, description_.integrator);
    build_options();
    SceneResolver resolver(description_, registry_, *scene_.wavelengths_);
    check_declarations(resolver);
    build_view(resolver);
    build_lights(resolver);
    build_surfaces(resolver);
    scene_.materials_ = resolver.materials();
    SharedWork shared;
    const Preparation preparation{*scene_.wavelengths_, pool_, log_, overrides_.cache_dir, &shared};
    for (const auto& [place, material] : scene_.materials_) material->prepare(preparation);
    index_lights();
    scene_.integrator_->prepare(scene_);
  }

 private:
  template <class Info, class... Args>
  auto make(const PluginTable<Info>& table, const ParsedPlugin& plugin, SceneResolver& resolver, const Args&... args) {
    const Info& info = table.get(plugin.name, plugin.where);
    return info.make(Params(info, plugin, resolver), args...);
  }

  template <class Info>
  void check(const PluginTable<Info>& table, const ParsedPlugin& plugin, SceneResolver& resolver) const {
    Params(table.get(plugin.name, plugin.where), plugin, resolver);
  }

  /// Also of what no shape uses: a name or parameter that is wrong is told at once.
  void check_declarations(SceneResolver& resolver) const {
    for (const TextureDescription& t : description_.textures) {
      if (t.value == TextureDescription::Value::real)
        check(registry_.float_textures, t.plugin, resolver);
      else
        check(registry_.spectrum_textures, t.plugin, resolver);
    }
    for (const MaterialDescription& m : description_.materials) check(registry_.materials, m.plugin, resolver);
    for (const ParsedPlugin& light : description_.area_lights) check(registry_.area_lights, light, resolver);
  }

  void build_options() {
    OptionResolver resolver(description_);
    const Params p(kOptions, {"Option", {}, description_.options}, resolver);
    seed_ = overrides_.seed;
    if (!seed_ && p.given("seed")) seed_ = uint64_t(p.integer("seed"));
    const auto [text, where] = wavelength_choice(description_, overrides_);
    scene_.wavelengths_name_ = text;
    scene_.wavelengths_ = make_wavelengths(text, where, description_, registry_);
  }

  void build_view(SceneResolver& resolver) {
    FilmSettings film = Scene::film_settings(description_, registry_);
    if (overrides_.quick) film = halved(film);
    scene_.film_ = film;
    scene_.camera_ = make(registry_.cameras, description_.camera, resolver,
                          CameraPlacement{description_.camera_from_world.inverse(), film.width, film.height});
    check_camera(film);
    scene_.sampler_ = make(registry_.samplers, description_.sampler, resolver, seed_);
    const int samples = scene_.sampler_->samples_per_pixel();
    scene_.samples_per_pixel_ = overrides_.quick ? std::max(1, samples / 16) : samples;
    scene_.filter_ = make(registry_.filters, description_.filter, resolver);
    scene_.integrator_ = make(registry_.integrators, description_.integrator, resolver);
  }

  /// Embree takes no ray whose numbers are too large; the film's corners and the lens's rim have the largest.
  void check_camera(const FilmSettings& film) const {
    constexpr float kFarthest = 1e12f;
    const auto within = [](const Vec3& v, float limit) {
      return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;  // false for NaN
    };
    for (const float x : {0.f, float(film.width)})
      for (const float y : {0.f, float(film.height)})
        for (const Vec2 lens : {Vec2{0, 0.5f}, Vec2{1, 0.5f}, Vec2{0.5f, 0}, Vec2{0.5f, 1}}) {
          const Ray ray = scene_.camera_->ray({x, y}, lens);
          if (!within(ray.o, kFarthest) || !within(ray.d, 2) || ray.d == Vec3{})
            fail(description_.camera.where, "this camera stands or reaches out of bounds: {:g} units at most",
                 kFarthest);
        }
  }

  void build_lights(SceneResolver& resolver) {
    for (const LightDescription& light : description_.lights)
      scene_.owned_lights_.push_back(make(registry_.lights, light.plugin, resolver, light.world_from_light));
  }

  void build_surfaces(SceneResolver& resolver) {
    std::vector<Primitive> top = primitives(description_.shapes, resolver);
    std::vector<std::vector<Primitive>> groups;
    for (const ObjectDescription& object : description_.objects) groups.push_back(primitives(object.shapes, resolver));
    std::vector<Placement> placements;
    placements.reserve(description_.instances.size());
    for (const InstanceDescription& instance : description_.instances) {
      check_scale(instance);
      placements.push_back({instance.world_from_object, instance.object});
    }
    scene_.accelerator_ = std::make_unique<Accelerator>(std::move(top), std::move(groups), placements, pool_.size());
    const Bounds b = scene_.accelerator_->bounds();
    scene_.radius_ = b.min.x <= b.max.x ? length(b.max - b.min) / 2 : 1;
  }

  std::vector<Primitive> primitives(const std::vector<ShapeDescription>& shapes, SceneResolver& resolver) {
    std::vector<Primitive> result;
    for (const ShapeDescription& shape : shapes) result.push_back(primitive(shape, resolver));
    return result;
  }

  Primitive primitive(const ShapeDescription& shape, SceneResolver& resolver) {
    const ShapeInfo& info = registry_.shapes.get(shape.plugin.name, shape.plugin.where);
    const Params params(info, shape.plugin, resolver);
    Primitive result{.geometry = info.make(params, {shape.world_from_object, shape.reverse_orientation}),
                     .alpha = nullptr,
                     .material_id = uint32_t(shape.material)};
    check_extent(result.geometry, shape.plugin.where);
    const auto alpha = params.float_texture("alpha");
    if (!alpha->is_constant() || alpha->range().min < 1) result.alpha = alpha;
    if (result.alpha && shape.area_light)
      fail(params.where("alpha"), "\"alpha\" on a shape that gives off light is not supported yet");
    const auto material = resolver.material(shape.material);
    result.material = material.get();
    if (shape.area_light)
      result.light =
          area_light(description_.area_lights[*shape.area_light], shape.plugin.where, result.geometry, resolver);
    if (material->is_leaf()) warn_of_double_faces(result.geometry, shape.plugin.where);
    return result;
  }

  /// Rays in the object's own space are longer or shorter by this; Embree's products of such numbers overflow or
  /// vanish.
  static void check_scale(const InstanceDescription& instance) {
    constexpr Interval kScale{1e-9, 1e9};
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      if (const double size = double(length(instance.world_from_object.vector(axis))); !kScale.contains(size))
        fail(instance.where, "this instance scales by {:g}: {:g} to {:g} is the limit", size, kScale.min, kScale.max);
  }

  /// Embree leaves out what lies farther than 1.8e18, without a word.
  static void check_extent(const ShapeGeometry& geometry, const Location& where) {
    static constexpr float kFarthest = 1e18f;
    const auto check = [&where](const Vec3& p) {
      if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthest))
        fail(where, "this shape reaches to ({:g}, {:g}, {:g}): {:g} units from the origin is the limit", p.x, p.y, p.z,
             kFarthest);
    };
    if (const auto* mesh = std::get_if<MeshPtr>(&geometry)) {
      std::for_each((*mesh)->p.begin(), (*mesh)->p.end(), check);
      return;
    }
    const AnalyticShape& shape = *std::get<AnalyticShapePtr>(geometry);
    for (unsigned i = 0; i < shape.count(); ++i) {
      check(shape.bounds(i).min);
      check(shape.bounds(i).max);
    }
  }

  const AreaLight* area_light(const ParsedPlugin& plugin, const Location& where, const ShapeGeometry& geometry,
                              SceneResolver& resolver) {
    if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry); shape && !(*shape)->cannot_emit().empty())
      fail(where, "this shape cannot give off light: {}; triangles can", (*shape)->cannot_emit());
    auto light = make(registry_.area_lights, plugin, resolver, geometry);
    const AreaLight* result = light.get();
    scene_.owned_lights_.push_back(std::move(light));
    return result;
  }

  /// Leaf meshes often carry each face twice, once for either side: a light path then meets two leaves in one.
  void warn_of_double_faces(const ShapeGeometry& geometry, const Location& where) {
    const auto* mesh = std::get_if<MeshPtr>(&geometry);
    if (!mesh) return;
    std::set<std::array<std::array<float, 3>, 3>> faces;
    size_t doubles = 0;
    for (const auto& t : (*mesh)->triangles) {
      std::array<std::array<float, 3>, 3> corners;
      for (size_t k = 0; k < 3; ++k) corners[k] = {(*mesh)->p[t[k]].x, (*mesh)->p[t[k]].y, (*mesh)->p[t[k]].z};
      std::sort(corners.begin(), corners.end());
      doubles += !faces.insert(corners).second;
    }
    if (doubles > 0)
      log_.warn(
          where,
          fmt::format("{} of {} faces of this leaf lie on one another: every ray passes two leaves there; a leaf has "
                      "its two sides in one face",
                      doubles, (*mesh)->triangles.size()));
  }

  void index_lights() {
    for (const auto& light : scene_.owned_lights_) {
      light->set_index(int(scene_.lights_.size()));
      scene_.lights_.push_back(light.get());
      if (const auto* environment = dynamic_cast<const EnvironmentLight*>(light.get()))
        scene_.environment_.push_back(environment);
    }
    if (scene_.lights_.empty()) log_.warn({}, "the scene has no light: the image will be black");
  }

  Scene& scene_;
  std::optional<uint64_t> seed_;  ///< of the command line or the scene's options; the sampler's own where there is none
  SceneDescription description_;
  const Registry& registry_;
  const SceneOverrides& overrides_;
  ThreadPool& pool_;
  const Log& log_;
};

const Material* Scene::material(size_t place) const {
  const auto it = materials_.find(place);
  return it == materials_.end() ? nullptr : it->second.get();
}

WavelengthChoice wavelength_choice(const SceneDescription& description, const SceneOverrides& overrides) {
  OptionResolver resolver(description);
  const Params p(kOptions, {"Option", {}, description.options}, resolver);
  if (!overrides.wavelengths.empty()) return {overrides.wavelengths, {}};
  return {p.string("wavelengths"), p.where("wavelengths")};
}

ParsedPlugin wavelengths_plugin(const std::string& text, const Location& where, const Registry& registry) {
  const PluginText choice = parse_plugin_text(text, where);
  ParsedPlugin plugin{choice.name, where, {}};
  set_params(choice, registry.wavelengths.get(choice.name, where), where, plugin);
  return plugin;
}

std::unique_ptr<WavelengthStrategy> make_wavelengths(const std::string& text, const Location& where,
                                                     const SceneDescription& description, const Registry& registry) {
  OptionResolver resolver(description);
  const ParsedPlugin plugin = wavelengths_plugin(text, where, registry);
  const WavelengthsInfo& info = registry.wavelengths.get(plugin.name, where);
  return info.make(Params(info, plugin, resolver));
}

FilmSettings Scene::film_settings(const SceneDescription& description, const Registry& registry) {
  OptionResolver resolver(description);
  const FilmInfo& info = registry.films.get(description.film.name, description.film.where);
  return info.make(Params(info, description.film, resolver));
}

std::vector<size_t> Scene::leaf_materials(const SceneDescription& description, const Registry& registry) {
  const auto wavelengths =
      make_wavelengths("smpte", {}, description, registry);  // what is a leaf does not hang on them
  SceneResolver resolver(description, registry, *wavelengths);
  std::vector<size_t> leaves;
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const ParsedPlugin& plugin = description.materials[i].plugin;
    const MaterialInfo& info = registry.materials.get(plugin.name, plugin.where);
    if (!is_mixture(info) && resolver.material(i)->is_leaf()) leaves.push_back(i);
  }
  return leaves;
}

Scene::Scene(const SceneDescription& description, const Registry& registry, const SceneOverrides& overrides,
             ThreadPool& pool, const Log& log) {
  SceneBuilder(*this, description, registry, overrides, pool, log).build();
}

Scene::~Scene() = default;

}  // namespace frond
