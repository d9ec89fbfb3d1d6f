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
#include "scene/textures/footprint.h"

namespace frond {

/// The strategy that the description's options name, with its parameters as a scene file has them. Throws InputError.
ParsedPlugin wavelengths_plugin(const SceneSettings& description, const Registry& registry);

/// The strategy itself. Throws InputError.
std::unique_ptr<WavelengthStrategy> make_wavelengths(const SceneSettings& description, const Registry& registry);

/// Of a surface: the light that all of it is, or one for each of its primitives.
struct SurfaceLights {
  const AreaLight* whole = nullptr;
  std::vector<const AreaLight*> by_primitive = {};

  /// nullptr: it gives off none.
  const AreaLight* at(uint32_t primitive) const { return by_primitive.empty() ? whole : by_primitive[primitive]; }
};

/// What gives off light in a scene.
struct LightTable {
  std::vector<std::unique_ptr<Light>> owned;
  std::vector<const Light*> all;
  std::vector<const EnvironmentLight*> environment;  ///< those that surround the scene
  std::vector<SurfaceLights> of_surface;             ///< by Geometry::surfaces

  void add(std::unique_ptr<Light> light);
};

/// A scene ready to be rendered: a geometry, and what the things in it are made of.
class Scene final : public World {
 public:
  /// What the scene says of its image, half of it where a first look will do; throws InputError.
  static FilmSettings film_settings(const SceneSettings& description, const Registry& registry,
                                    const Log& log = silent_log());

  /// Which of the description's materials are leaves (Material::is_leaf), by index. A mixture of others is none: its
  /// parts stand for themselves. Throws InputError.
  static std::vector<size_t> leaf_materials(const SceneSettings& description, const Registry& registry);

  /// `cache`: folder of tables that are computed here; empty: no files are kept.
  /// `other`: a scene in which the same stands: the geometry is then that one, whatever shapes are described, and so
  /// are lights and materials as far as they do not differ. The description is the other's but for its materials,
  /// wavelengths, integrator and view. `shared` holds what such scenes have in common. Throws InputError.
  Scene(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log,
        const std::filesystem::path& cache = {}, const Scene* other = nullptr, SharedWork* shared = nullptr);
  ~Scene() override;

  /// Loads all that the scene names, whether a shape needs it or not, and makes nothing of it. Throws InputError, with
  /// all that is wrong.
  static void check(const SceneDescription& description, const Registry& registry, ThreadPool& pool, const Log& log);

  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const override;
  bool occluded(const Ray& ray, uint64_t key) const override;
  uint32_t intersect(const RayPacket& packet, SurfacePoint* points) const override;
  uint32_t occluded(const RayPacket& packet) const override;
  std::span<const Light* const> lights() const override { return lights_->all; }
  std::span<const EnvironmentLight* const> environment() const override { return lights_->environment; }
  float radius() const override { return radius_; }

  const WavelengthStrategy& wavelengths() const override { return *wavelengths_; }
  const std::string& wavelengths_name() const { return wavelengths_name_; }
  const FilmSettings& film() const { return film_; }
  const Camera& camera() const { return *camera_; }
  const Sampler& sampler() const { return *sampler_; }
  const Filter& filter() const { return *filter_; }
  const Integrator& integrator() const { return *integrator_; }
  const Geometry& geometry() const { return *geometry_; }
  /// Along x and y, after which the scene is repeated; empty: it is not.
  std::optional<Vec2> period() const { return period_; }
  /// The material of this index in the description; nullptr where nothing is made of it.
  const Material* material(size_t index) const { return material_at_[index]; }
  int samples_per_pixel() const { return samples_per_pixel_; }
  /// Else all samples lie at the pixels' centres and the lens's.
  bool has_pixel_jitter() const { return has_pixel_jitter_; }
  /// Else all samples have the same wavelengths.
  bool has_wavelength_jitter() const { return has_wavelength_jitter_; }
  /// Of all random numbers.
  uint64_t seed() const { return sampler_->seed(); }

 private:
  friend class SceneBuilder;
  Scene();

  bool meets(const Ray& ray, uint64_t key, GeometryHit& nearest, Hit& hit) const;
  void describe(const GeometryHit& at, SurfacePoint& point) const;
  void add_details(uint32_t material, Hit& hit) const;

  std::string wavelengths_name_;
  std::unique_ptr<WavelengthStrategy> wavelengths_;
  FilmSettings film_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Sampler> sampler_;
  std::unique_ptr<Filter> filter_;
  std::unique_ptr<Integrator> integrator_;
  std::map<size_t, MadeMaterial> materials_;         ///< by their index in the description
  std::map<size_t, ParsedPlugin> material_plugins_;  ///< what they were made from
  std::vector<const Material*> material_at_;         ///< `materials_` for hits; nullptr where nothing is made
  std::vector<uint8_t> is_detailed_;                 ///< by index: whether hits need details
  std::vector<const NormalBend*> bend_at_;           ///< by index; nullptr: none
  Footprint footprint_;
  std::shared_ptr<const LightTable> lights_;
  std::shared_ptr<const Geometry> geometry_;
  std::optional<Vec2> period_;
  std::optional<Tiling> tiling_;
  float radius_ = 0;
  int samples_per_pixel_ = 0;
  bool has_pixel_jitter_ = true, has_wavelength_jitter_ = true;
};

}  // namespace frond
