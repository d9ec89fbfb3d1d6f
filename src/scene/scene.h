#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "core/log.h"
#include "core/parallel.h"
#include "core/world.h"
#include "scene/format/description.h"
#include "scene/geometry/geometry.h"
#include "scene/geometry/tiling.h"
#include "scene/registry.h"
#include "scene/resolver.h"
#include "textures/footprint.h"

namespace frond {

struct CameraSampling;

/// Returns the wavelength strategy of the description's options, with its parameters. Throws InputError.
ParsedPlugin wavelengths_plugin(const SceneSettings& description, const Registry& registry);

/// Returns the wavelength strategy object, with the sensor of the film and the wavelengths of its buckets. Warns of
/// what has no effect on it. Throws InputError.
std::unique_ptr<WavelengthStrategy> make_wavelengths(const SceneSettings& description, const Registry& registry,
                                                     const Log& log = silent_log());

/// Sets the film's buckets to 0, with a warning, if the scene's wavelengths are of a strategy that does not sample
/// them. Throws InputError if they do not reach all buckets.
void fit_buckets(const SceneSettings& description, const Registry& registry, FilmSettings& film, const Log& log);

/// Lights of a surface: one for the whole surface, or one for each primitive.
struct SurfaceLights {
  const AreaLight* whole = nullptr;
  std::vector<const AreaLight*> by_primitive = {};

  /// Returns nullptr if the primitive emits no light.
  const AreaLight* at(uint32_t primitive) const { return by_primitive.empty() ? whole : by_primitive[primitive]; }
};

/// All lights of a scene.
struct LightTable {
  std::vector<std::unique_ptr<Light>> owned;
  std::vector<const Light*> all;
  std::vector<Location> where;                       ///< of each of `all` in the scene file
  std::vector<const EnvironmentLight*> environment;  ///< the infinite ones among them
  std::vector<SurfaceLights> of_surface;             ///< by index in Geometry::surfaces
  std::vector<ParsedPlugin> plugins;                 ///< that the description's lights were created from

  void add(std::unique_ptr<Light> light, const Location& at);
};

/// All media of a scene.
struct MediumTable {
  std::vector<std::unique_ptr<const Medium>> owned;  ///< by index in the description
  std::vector<MediumInterface> interfaces;           ///< by index in the description
  const Medium* of_camera = nullptr;
};

/// A scene ready to be rendered: geometry, materials, lights, camera, film, sampler and integrator.
class Scene final : public World {
 public:
  /// Returns the film's settings, at half resolution for a preview. Throws InputError.
  static FilmSettings film_settings(const SceneSettings& description, const Registry& registry,
                                    const Log& log = silent_log());

  /// Returns the shares of all motion that are done when the camera's shutter opens and closes (Motion). Throws
  /// InputError.
  static Interval shutter(const SceneSettings& description, const Registry& registry, const Log& log = silent_log());

  /// `cache`: folder for computed tables; empty: none are stored. `other`: a scene that differs only in materials,
  /// parameters of lights, wavelengths, integrator and view; its geometry is shared regardless of the described shapes,
  /// and so are equal lights and materials. `shared` holds work common to such scenes. Throws InputError.
  Scene(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log,
        const std::filesystem::path& cache = {}, const Scene* other = nullptr, SharedWork* shared = nullptr);
  ~Scene() override;

  /// Loads everything that the scene names, whether used or not, without building it. Throws InputError with all
  /// errors.
  static void check(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log);

  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const override;
  /// Same, and also returns the indices of the hit.
  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point, GeometryHit& at) const;
  bool occluded(const Ray& ray, uint64_t key) const override;
  uint32_t intersect(const RayPacket& packet, SurfacePoint* points) const override;
  uint32_t occluded(const RayPacket& packet) const override;
  std::span<const Light* const> lights() const override { return lights_->all; }
  std::span<const EnvironmentLight* const> environment() const override { return lights_->environment; }
  const Location& light_where(size_t index) const { return lights_->where[index]; }
  std::span<const MediumInterface> medium_interfaces() const override { return media_->interfaces; }
  const Medium* camera_medium() const override { return media_->of_camera; }
  float radius() const override { return radius_; }

  const WavelengthStrategy& wavelengths() const override { return *wavelengths_; }
  const std::string& wavelengths_name() const { return wavelengths_name_; }
  const FilmSettings& film() const { return film_; }
  const Camera& camera() const { return *camera_; }
  /// Whether anything moves while the shutter is open: rays need a time.
  bool has_motion() const { return camera_motion_.has_value() || geometry_->has_motion(); }
  const Sampler& sampler() const { return *sampler_; }
  /// Arguments of CameraSamples, with the scene's sampler or another one; they refer to the scene.
  CameraSampling camera_sampling() const;
  CameraSampling camera_sampling(const Sampler& sampler) const;
  const Filter& filter() const { return *filter_; }
  const Integrator& integrator() const { return *integrator_; }
  const Geometry& geometry() const { return *geometry_; }
  /// Point of the scene file's world that is the origin of this one: SceneOrigins.
  const Vec3d& origin() const { return origin_; }
  /// Period along x and y; nullopt: the scene is not repeated.
  std::optional<Vec2> period() const { return period_; }
  /// Returns the material with this index in the description; nullptr if it is unused.
  const Material* material(size_t index) const { return material_at_[index]; }
  /// By index in the description: whether the material is a leaf, or a mixture with one.
  std::span<const uint8_t> leaf_flags() const { return is_leaf_; }
  int samples_per_pixel() const { return samples_per_pixel_; }
  /// If false, all samples are at the centres of pixels and lens.
  bool has_pixel_jitter() const { return has_pixel_jitter_; }
  /// Seed of all random numbers.
  uint64_t seed() const { return sampler_->seed(); }

 private:
  friend class SceneBuilder;
  Scene();

  bool find_nearest(const Ray& ray, uint64_t key, GeometryHit& nearest, Hit& hit) const;
  void compute_point(const GeometryHit& at, SurfacePoint& point) const;
  void add_details(uint32_t material, Hit& hit) const;

  Vec3d origin_{};
  std::string wavelengths_name_;
  std::unique_ptr<WavelengthStrategy> wavelengths_;
  FilmSettings film_;
  std::unique_ptr<Camera> camera_;
  std::optional<CameraMotion> camera_motion_;
  std::unique_ptr<Sampler> sampler_;
  std::unique_ptr<Filter> filter_;
  std::unique_ptr<Integrator> integrator_;
  std::map<size_t, MadeMaterial> materials_;         ///< by index in the description
  std::map<size_t, ParsedPlugin> material_plugins_;  ///< the plug-ins that they were created from
  std::vector<const Material*> material_at_;         ///< as `materials_`, for hits; nullptr: unused
  std::vector<uint8_t> is_detailed_;                 ///< by material index: whether hits need derivatives
  std::vector<uint8_t> is_leaf_;                     ///< leaf_flags
  std::vector<const NormalBend*> bend_at_;           ///< by material index; nullptr: none
  Footprint footprint_;
  std::shared_ptr<const LightTable> lights_;
  std::shared_ptr<const MediumTable> media_;
  std::shared_ptr<const Geometry> geometry_;
  std::optional<Vec2> period_;
  std::optional<Tiling> tiling_;
  float radius_ = 0;
  int samples_per_pixel_ = 0;
  bool has_pixel_jitter_ = true, has_wavelength_jitter_ = true;
};

}  // namespace frond
