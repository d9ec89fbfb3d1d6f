#include <algorithm>
#include <cmath>

#include "core/camera_samples.h"
#include "core/messages/problems.h"
#include "core/stop.h"
#include "scene/fluorescence_by_material.h"
#include "scene/format/plugin_text.h"
#include "scene/geometry/shape_emitter.h"
#include "scene/geometry_builder.h"
#include "scene/leaf_models.h"
#include "scene/origin.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "scene/subsurface_materials.h"
#include "spectra/check_range.h"
#include "textures/normal_map.h"

namespace frond {
/// Builds the scene from the description in order of dependency. After an error it continues with independent objects,
/// and throws all errors together.
class SceneBuilder {
 public:
  SceneBuilder(Scene& scene, const SceneSettings& settings, const Registry& registry, ThreadPool& pool, const Log& log,
               const std::filesystem::path& cache)
      : scene_(scene), description_(settings), registry_(registry), pool_(pool), log_(log), cache_(cache) {}

  /// Builds a scene. `other` may be nullptr.
  void build(const SceneDescription& description, const Scene* other, SharedWork& shared) {
    if (other) return build(*other, shared);
    const auto resolver = build_settings();
    build_world(description, *resolver);
    problems_.check();
    finish(*resolver, shared);
  }

  /// Checks shapes and everything that the description declares, used or not.
  void check(const SceneDescription& description) {
    const auto resolver = build_settings();
    bind_all(*resolver);
    build_world(description, *resolver);
    problems_.attempt([this] { check_period(); });
    check_table_files(*resolver);
    problems_.check();
  }

 private:
  /// Builds a scene that shares the geometry of `other`, and its equal lights and materials.
  void build(const Scene& other, SharedWork& shared) {
    const auto resolver = build_settings();
    problems_.check();
    scene_.geometry_ = other.geometry_;
    const bool same_wavelengths = scene_.wavelengths_name_ == other.wavelengths_name_;
    if (same_wavelengths)
      scene_.media_ = other.media_;
    else
      build_media(*resolver);
    if (same_wavelengths && has_lights_of(other)) {
      scene_.lights_ = other.lights_;
    } else {
      build_lights(*resolver);
      build_area_lights(*resolver);
    }
    for (const auto& [place, material] : other.materials_) {
      const ParsedPlugin& plugin = description_.materials[place].plugin;
      if (same_wavelengths && same_plugin(plugin, other.material_plugins_.at(place)) &&
          !is_mixture(registry_.materials.get(plugin.name, plugin.where)))
        scene_.materials_.emplace(place, material);
      else
        resolver->material(place);
    }
    problems_.check();
    finish(*resolver, shared);
  }

  /// Prepares the materials whose tables are files, which takes no time: a file may lack the wavelengths of the render.
  void check_table_files(SceneResolver& resolver) {
    const Preparation preparation{*scene_.wavelengths_, pool_, log_, {}};
    for (const auto& [place, made] : resolver.materials())
      if (reads_table(description_.materials[place].plugin, registry_))
        problems_.attempt([&] { made.material->prepare(preparation); });
  }

  /// Builds everything that is located in the scene.
  void build_world(const SceneDescription& description, SceneResolver& resolver) {
    check_declarations(resolver);
    build_media(resolver);
    build_lights(resolver);
    Interval shutter{0, 1};
    problems_.attempt([&] { shutter = Scene::shutter(description_, registry_); });
    scene_.geometry_ = build_geometry(description, registry_, resolver, shutter, pool_, log_, problems_);
    check_instance_textures(description_, *scene_.geometry_, log_);
    build_area_lights(resolver);
  }

  /// Returns the resolver; nullptr if the wavelengths are invalid, because parameters cannot be bound without them.
  std::unique_ptr<SceneResolver> build_settings() {
    problems_.attempt([this] { build_options(); });
    if (!scene_.wavelengths_) problems_.check();
    auto resolver = std::make_unique<SceneResolver>(description_, registry_, *scene_.wavelengths_, log_);
    build_view(*resolver);
    return resolver;
  }

  /// Prepares the materials, which may compute tables, and fills the lookups by material index.
  void finish(SceneResolver& resolver, SharedWork& shared) {
    const Preparation preparation{*scene_.wavelengths_, pool_, log_, cache_, &shared};
    for (const auto& [place, made] : resolver.materials()) {
      made.material->prepare(preparation);
      scene_.materials_.emplace(place, made);
    }
    scene_.material_at_.resize(description_.materials.size());
    scene_.is_detailed_.resize(description_.materials.size());
    scene_.bend_at_.resize(description_.materials.size());
    scene_.is_leaf_ = leaf_flags(description_, registry_);
    for (const auto& [place, made] : scene_.materials_) {
      scene_.material_at_[place] = made.material.get();
      scene_.is_detailed_[place] = made.needs_details;
      scene_.bend_at_[place] = made.bend.get();
      scene_.material_plugins_.emplace(place, description_.materials[place].plugin);
    }
    const Bounds b = scene_.geometry_->bounds();
    scene_.radius_ = b.is_empty() ? 1 : length(b.max - b.min) / 2;
    check_rays(b);
    build_tiling();
    if (has_fluorescence(*scene_.wavelengths_)) set_fluorescence(preparation);
    set_subsurface(scene_.material_at_, description_, *scene_.wavelengths_, *scene_.integrator_);
    scene_.integrator_->prepare(scene_);
    if (const std::string adapted = scene_.integrator_->adapt(scene_, scene_.camera_sampling()); !adapted.empty())
      log_.info(adapted);
  }

  /// Passes the fluorescence of the materials to the integrator. Throws InputError if it computes none.
  void set_fluorescence(const Preparation& preparation) {
    FluorescenceIntegrator& integrator = fluorescence_integrator(*scene_.integrator_, description_.integrator);
    for (size_t i = 0; i < scene_.is_leaf_.size(); ++i)
      if (const ParsedPlugin& plugin = description_.materials[i].plugin;
          scene_.is_leaf_[i] && scene_.material_at_[i] &&
          is_mixture(registry_.materials.get(plugin.name, plugin.where)))
        log_.warn(plugin.where, "the leaves of a mixture do not fluoresce");
    integrator.set_fluorescence(fluorescence_by_material(scene_.material_at_, preparation));
  }

  template <class Info, class... Args>
  auto make(const PluginTable<Info>& table, const ParsedPlugin& plugin, SceneResolver& resolver, const Args&... args) {
    const Info& info = table.get(plugin.name, plugin.where);
    return make_checked(info, plugin.where, [&] { return info.make(Params(info, plugin, resolver), args...); });
  }

  template <class Info>
  void check(const PluginTable<Info>& table, const ParsedPlugin& plugin, SceneResolver& resolver) {
    problems_.attempt([&] { Params(table.get(plugin.name, plugin.where), plugin, resolver); });
  }

  /// Checks names and parameters of all declarations, including those that no shape uses.
  void check_declarations(SceneResolver& resolver) {
    for (const TextureDescription& t : description_.textures) {
      if (t.value == TextureDescription::Value::real)
        check(registry_.float_textures, t.plugin, resolver);
      else
        check(registry_.spectrum_textures, t.plugin, resolver);
    }
    for (const MaterialDescription& m : description_.materials) {
      check(registry_.materials, split_bend(m.plugin, false), resolver);
      problems_.attempt([&] { Params(normal_bend_params, split_bend(m.plugin, true), resolver); });
    }
    for (const ParsedPlugin& light : description_.area_lights) check(registry_.area_lights, light, resolver);
  }

  /// Creates all materials and textures, including unused ones.
  void bind_all(SceneResolver& resolver) {
    for (const TextureDescription& t : description_.textures)
      problems_.attempt([&] {
        if (t.value == TextureDescription::Value::real)
          (void)resolver.float_texture(t.name, t.plugin.where);
        else
          (void)resolver.spectrum_texture(t.name, t.plugin.where);
      });
    for (size_t i = 0; i < description_.materials.size(); ++i) problems_.attempt([&] { (void)resolver.material(i); });
    for (const ParsedPlugin& light : description_.area_lights)
      problems_.attempt([&] {
        const AreaLightInfo& info = registry_.area_lights.get(light.name, light.where);
        const Params params(info, light, resolver);
        for (const Param& p : info.params)
          if (p.kind == ParamKind::illuminant && params.given(p.name)) (void)params.spectrum(p.name);
      });
  }

  /// Reads Options, which later steps depend on.
  void build_options() {
    const SceneOptions options = read_options(description_, log_);
    scene_.has_pixel_jitter_ = options.has_pixel_jitter;
    scene_.has_wavelength_jitter_ = options.has_wavelength_jitter;
    filters_textures_ = options.filters_textures;
    seed_ = options.seed;
    period_ = options.period, period_where_ = options.period_where;
    scene_.wavelengths_name_ = options.wavelengths;
    scene_.wavelengths_ = make_wavelengths(description_, registry_, log_);
  }

  /// Throws InputError for lights at finite positions in a periodic scene, because they would have to be repeated.
  void check_period() const {
    if (!period_ || !scene_.lights_) return;
    for (const Light* light : scene_.lights_->all)
      if (!light->is_distant())
        fail(scene_.lights_->where[size_t(light->index())],
             "a scene with a \"period\" takes light from outside alone: \"distant\", \"sky\", or \"infinite\" without "
             "a portal");
    for (size_t i = 0; i < description_.media.size(); ++i)
      if (scene_.media_ && scene_.media_->owned[i] && !scene_.media_->owned[i]->is_homogeneous())
        fail(description_.media[i].plugin.where,
             "a scene with a \"period\" takes media that are the same everywhere: this one would not be repeated");
  }

  /// Repeats the geometry, if there is a period.
  void build_tiling() {
    if (!period_) return;
    check_period();
    const Bounds bounds = scene_.geometry_->bounds();
    constexpr float kMostPeriods = 64;  // a ray visits each cell that could hold what it meets
    const float periods =
        std::max((bounds.max.x - bounds.min.x) / period_->x, (bounds.max.y - bounds.min.y) / period_->y);
    if (!(periods <= kMostPeriods))
      fail(period_where_, "the scene is {:.6g} periods wide: {} is the limit", periods, kMostPeriods);
    scene_.period_ = period_;
    scene_.tiling_.emplace(*period_, scene_.geometry_->bounds());
  }

  /// Builds film, camera, filter, sampler and integrator.
  void build_view(SceneResolver& resolver) {
    const MovingTransform world_from_camera = description_.camera_from_world.inverse();
    CameraPlacement placement{world_from_camera.start, 0, 0};
    const bool has_film = problems_.attempt([&] {
      scene_.film_ = Scene::film_settings(description_, registry_, log_);
      placement.width = scene_.film_.width, placement.height = scene_.film_.height;
    });
    // A camera depends on the film's aspect ratio. Without a film, only its parameters are checked.
    if (has_film)
      problems_.attempt([&] {
        scene_.camera_ = make(registry_.cameras, description_.camera, resolver, placement);
        if (world_from_camera.moves()) build_camera_motion(world_from_camera);
        check_camera(scene_.film_);
      });
    else
      check(registry_.cameras, description_.camera, resolver);
    problems_.attempt([&] { scene_.sampler_ = make(registry_.samplers, description_.sampler, resolver, seed_); });
    problems_.attempt([&] { scene_.filter_ = make(registry_.filters, description_.filter, resolver); });
    problems_.attempt([&] { scene_.integrator_ = make(registry_.integrators, description_.integrator, resolver); });
    if (!problems_.empty()) return;
    if (filters_textures_) scene_.footprint_ = Footprint(*scene_.camera_, placement, scene_.has_pixel_jitter_);
    const int samples = scene_.sampler_->samples_per_pixel();
    scene_.samples_per_pixel_ = description_.is_quick ? std::max(1, samples / 16) : samples;
    problems_.attempt([this] { check_filter(); });
  }

  void build_camera_motion(const MovingTransform& world_from_camera) {
    const AffineMap start{world_from_camera.start.rows()}, end{world_from_camera.end->rows()};
    if (const std::string problem = problem_of_motion(start, end); !problem.empty())
      fail(description_.camera.where, "this camera cannot move so: {}", problem);
    scene_.camera_motion_.emplace(start, end, Scene::shutter(description_, registry_));
  }

  /// A camera with unrelated pixels requires a filter that stays within a pixel.
  void check_filter() const {
    if (scene_.camera_->pixels_are_apart() && !scene_.filter_->stays_in_pixel())
      fail(description_.filter.where.file ? description_.filter.where : description_.camera.where,
           "the pixels of this camera have nothing to do with each other, and \"{}\" mixes them: PixelFilter \"box\" "
           "does not",
           description_.filter.name);
  }

  /// The film's corners and the lens's edge have rays with the largest coordinates.
  void check_camera(const FilmSettings& film) {
    constexpr float kLongest = 2;  // directions are unit vectors, apart from rounding
    for (const float x : {0.f, float(film.width)})
      for (const float y : {0.f, float(film.height)})
        for (const Vec2 lens : {Vec2{0, 0.5f}, Vec2{1, 0.5f}, Vec2{0.5f, 0}, Vec2{0.5f, 1}}) {
          Ray ray = scene_.camera_->ray({x, y}, lens);
          if (scene_.camera_motion_) scene_.camera_motion_->move(ray);
          check_coordinates(ray.o, "a ray of this camera starts at", description_.camera.where);
          if (const float length_sq = dot(ray.d, ray.d); !(length_sq > 0 && length_sq < kLongest))
            fail(description_.camera.where, "a ray of this camera has no direction");
          reach_ = std::max(reach_, largest_coordinate(ray.o));
        }
  }

  /// Rays become long in the spaces of small instances.
  void check_rays(const Bounds& bounds) {
    constexpr float kMost = 1.8e18f;  // Embree's limit
    if (!bounds.is_empty()) reach_ = std::max({reach_, largest_coordinate(bounds.min), largest_coordinate(bounds.max)});
    if (const float largest = scene_.geometry_->largest_ray_coordinate(reach_); !(largest <= kMost))
      fail(description_.camera.where,
           "the scene with its camera and lights reaches to {:g} units from the origin, which in the space of its "
           "smallest instances are {:g}: {:g} is the limit",
           reach_, largest, kMost);
  }

  /// Media that fail are reported together.
  void build_media(SceneResolver& resolver) {
    auto table = std::make_shared<MediumTable>();
    for (const MediumDescription& medium : description_.media) {
      table->owned.emplace_back();
      problems_.attempt([&] {
        table->owned.back() = make(registry_.media, medium.plugin, resolver, medium.world_from_medium);
        table->owned.back()->check(*scene_.wavelengths_);
      });
    }
    const auto at = [&table](const std::optional<size_t>& i) { return i ? table->owned[*i].get() : nullptr; };
    for (const MediumPair& pair : description_.medium_interfaces)
      table->interfaces.push_back({at(pair.inside), at(pair.outside)});
    table->of_camera = at(description_.camera_medium);
    scene_.media_ = std::move(table);
    if (const IntegratorInfo* info = registry_.integrators.find(description_.integrator.name);
        info && info->ignores_media && description_.has_media())
      log_.warn(description_.integrator.where,
                fmt::format("integrator \"{}\" ignores the scene's media{}", info->name, other_integrator()));
  }

  /// Returns "; \"NAME\" does not" for the first integrator that takes media into account.
  std::string other_integrator() const {
    for (const IntegratorInfo* info : registry_.integrators.all())
      if (!info->ignores_media) return fmt::format("; \"{}\" does not", info->name);
    return {};
  }

  /// Returns whether the described lights, which are the same ones, have the parameters of those of `other`.
  bool has_lights_of(const Scene& other) const {
    return std::ranges::equal(description_.lights, other.lights_->plugins, same_plugin, &LightDescription::plugin);
  }

  /// Lights that fail are reported together.
  void build_lights(SceneResolver& resolver) {
    for (const LightDescription& light : description_.lights) {
      lights_->plugins.push_back(light.plugin);
      problems_.attempt(
          [&] { add(make(registry_.lights, light.plugin, resolver, light.world_from_light), light.plugin.where); });
    }
  }

  const Light* add(std::unique_ptr<Light> light, const Location& where) {
    // One light of infinite or NaN power would break the selection of lights by power.
    if (const double power = light->power(1); !(std::isfinite(power) && power >= 0))
      fail(where, "this light has the power {}, which is not possible", power);
    check_range(light->range_nm(), *scene_.wavelengths_, where, "emission");
    if (const auto bounds = light->bounds())
      for (const Vec3& p : {bounds->min, bounds->max}) {
        check_coordinates(p, "this light reaches to", where);
        reach_ = std::max(reach_, largest_coordinate(p));
      }
    if (const std::string summary = light->summary(); !summary.empty()) log_.info(summary);
    const Light* const added = light.get();
    lights_->add(std::move(light), where);
    return added;
  }

  /// Creates a light for each emissive surface. Must be called last.
  void build_area_lights(SceneResolver& resolver) {
    emissions_.resize(description_.area_lights.size());
    for (const Surface& surface : scene_.geometry_->surfaces()) {
      lights_->of_surface.emplace_back();
      if (surface.area_light)
        problems_.attempt([&] { build_area_light(surface, resolver, lights_->of_surface.back()); });
    }
    // A line with an error might have been a light.
    if (lights_->all.empty() && problems_.empty() && !description_.has_errors)
      log_.warn({}, "the scene has no light: the image will be black");
    scene_.lights_ = std::move(lights_);
  }

  /// Returns the emission of a directive. It is shared by all of its shapes, so that images are read and spectra fitted
  /// once.
  const AreaEmission& emission_of(size_t place, SceneResolver& resolver) {
    if (!emissions_[place]) emissions_[place] = make(registry_.area_lights, description_.area_lights[place], resolver);
    return *emissions_[place];
  }

  /// Creates one light for the surface, or one for each face if the directive states a power.
  void build_area_light(const Surface& surface, SceneResolver& resolver, SurfaceLights& of_surface) {
    const AreaEmission& emission = emission_of(*surface.area_light, resolver);
    const Location& where = description_.area_lights[*surface.area_light].where;
    const auto add_over = [&](std::unique_ptr<const EmittingSurface> emitting) {
      // Lights divide by the area.
      if (const double area = emitting->area(); !(std::isfinite(area) && area > 0))
        fail(where, "an area light needs a surface with an area, this one has {}", area);
      auto light = make_checked(registry_.area_lights.get(description_.area_lights[*surface.area_light].name, where),
                                where, [&] { return emission.make_area_light(std::move(emitting)); });
      const AreaLight* const added = light.get();
      add(std::move(light), where);
      return added;
    };
    const unsigned faces = faces_of(surface.geometry);
    if (faces == 1 || !emission.is_by_face()) {
      of_surface.whole = add_over(std::make_unique<ShapeEmitter>(surface));
      return;
    }
    log_.warn(where, fmt::format("each of the shape's {} triangles or patches emits this \"power\", as in pbrt-v4: "
                                 "all of them together {} times as much",
                                 faces, faces));
    of_surface.by_primitive.resize(primitives_of(surface.geometry));
    StopPoll poll;
    for (unsigned i = 0; i < of_surface.by_primitive.size(); poll()) {
      const Primitives face = face_of(surface.geometry, i);
      auto emitting = std::make_unique<ShapeEmitter>(surface, face);
      const AreaLight* const light = emitting->area() > 0 ? add_over(std::move(emitting)) : nullptr;
      for (; i < face.end; ++i) of_surface.by_primitive[i] = light;
    }
  }

  Scene& scene_;
  std::optional<uint64_t> seed_;  ///< empty: the sampler's seed
  std::optional<Vec2> period_;
  Location period_where_;
  bool filters_textures_ = true;
  Problems problems_;
  const SceneSettings& description_;
  const Registry& registry_;
  ThreadPool& pool_;
  const Log& log_;
  const std::filesystem::path& cache_;
  std::shared_ptr<LightTable> lights_ = std::make_shared<LightTable>();
  float reach_ = 0;                                       ///< largest coordinate of camera and lights
  std::vector<std::unique_ptr<AreaEmission>> emissions_;  ///< by index of the area light; created on first use
};

/// The index identifies the light for light samplers.
void LightTable::add(std::unique_ptr<Light> light, const Location& at) {
  light->set_index(int(all.size()));
  all.push_back(light.get());
  where.push_back(at);
  if (const auto* surrounding = dynamic_cast<const EnvironmentLight*>(light.get())) environment.push_back(surrounding);
  owned.push_back(std::move(light));
}

Scene::Scene(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log,
             const std::filesystem::path& cache, const Scene* other, SharedWork* shared) {
  SharedWork own;
  const auto moved = moved_to_origins(description, registry, log, other ? &other->origin_ : nullptr, origin_);
  const SceneDescription& near = moved ? *moved : description;
  SceneBuilder(*this, near, registry, pool, log, cache).build(near, other, shared ? *shared : own);
}

/// Builds into a scene that is discarded.
void Scene::check(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log) {
  Scene scene;
  const auto moved = moved_to_origins(description, registry, log, nullptr, scene.origin_);
  const SceneDescription& near = moved ? *moved : description;
  SceneBuilder(scene, near, registry, pool, log, {}).check(near);
}

}  // namespace frond
