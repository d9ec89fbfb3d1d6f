#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/math/transform.h"
#include "core/plugin.h"
#include "core/shape.h"
#include "core/spectrum.h"

namespace frond {

/// Sample of the light that arrives at a point, as pbrt's LightLiSample.
struct LightSample {
  SampledSpectrum radiance;  ///< W/(m^2 sr nm) before film scaling; of a delta light: irradiance at normal incidence
  Vec3 wi;                   ///< from the point toward the light, unit
  float distance = 0;        ///< infinity for lights outside the scene
  float pdf = 0;             ///< per solid angle at the point; 1 for a delta light
};

/// Bounds of a light's position and of the directions into which it emits, as pbrt's LightBounds.
struct LightBounds {
  Vec3 min, max;           ///< bounding box of its points, world space
  Vec3 axis{0, 0, 1};      ///< axis of a cone around its normals, unit
  float cos_spread = -1;   ///< cosine of the largest angle between a normal and the axis (pbrt's cosTheta_o)
  float cos_reach = 0;     ///< cosine of the largest angle between emission and a normal (pbrt's cosTheta_e)
  bool two_sided = false;  ///< it emits equally into the opposite directions
};

/// Light source. Thread-safe once the scene is set up.
class Light {
 public:
  virtual ~Light() = default;
  /// Samples the light that arrives at `p`, in world space, for a uniform `u` in [0, 1)^2; empty if none arrives.
  virtual std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const = 0;
  /// Share of the light's power that `sample_compensated` covers. With 0 the light is found by scattered rays alone.
  virtual double compensated_share() const { return 1; }
  /// Like `sample`, for multiple importance sampling with scattered rays: its density may leave out light that these
  /// find as well (MIS compensation, Karlik et al. 2019).
  virtual std::optional<LightSample> sample_compensated(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const {
    return sample(p, u, lambda);
  }
  /// True for light through a point or from a single direction, which no scattered ray meets.
  virtual bool is_delta() const = 0;
  /// True for light from outside the scene.
  virtual bool is_distant() const { return false; }
  /// Photometric power in a scene with this radius, for choosing among lights: photometric() of spectra/cie.h of the
  /// spectrum, times 4 pi for the intensity of a point, pi r^2 for the irradiance of a distant light, pi and the area
  /// for an emitting surface, 4 pi^2 r^2 for the radiance of an environment.
  virtual double power(float scene_radius) const = 0;
  /// Bounds for choosing lights by their contribution at a point; empty if the light has none.
  virtual std::optional<LightBounds> bounds() const { return {}; }
  /// Emission spectrum up to a factor; for a light with an image, the spectrum of its white.
  virtual const Spectrum& emission() const = 0;
  /// Direction toward the sun that an extended light contains, unit; empty if it has none. Most of such a light can
  /// come from a solid angle so small that only `sample` finds it. Delta lights leave it empty.
  virtual std::optional<Vec3> sun() const { return {}; }
  /// Line for the log: physical quantities of the light that its parameters do not state. Empty if there are none.
  virtual std::string summary() const { return {}; }
  /// Wavelengths (nm) for which there are emission data.
  Interval range_nm() const { return emission().range_nm(); }

  /// Index in World::lights.
  int index() const { return index_; }
  void set_index(int index) { index_ = index; }

 private:
  int index_ = 0;
};

/// Plug-in record of a light.
struct LightInfo : PluginInfo {
  /// Returns a light, not null. Throws InputError.
  std::unique_ptr<Light> (*make)(const Params&, const Transform& world_from_light);
};

/// `make` of a light class T with a constructor T(const Params&, const Transform&).
template <class T>
std::unique_ptr<Light> make_light(const Params& p, const Transform& world_from_light) {
  return std::make_unique<T>(p, world_from_light);
}

/// Point of an emitting surface.
struct EmittingPoint {
  Vec3 p;   ///< world space
  Vec3 ng;  ///< geometric normal, unit, on the front
  Vec2 uv;  ///< texture coordinates
};

/// Light emitted by a surface of the scene.
class AreaLight : public Light {
 public:
  /// Radiance emitted at the point in the direction `w`.
  virtual SampledSpectrum radiance(const EmittingPoint& at, const Vec3& w, const SampledWavelengths& lambda) const = 0;
  /// Density, per solid angle at `from`, with which `sample` chooses the point `at` of the surface.
  virtual float pdf(const Vec3& from, const EmittingPoint& at) const = 0;
};

/// Surface of an area light: a shape or one of its faces, in world space. The renderer implements it.
class EmittingSurface {
 public:
  virtual ~EmittingSurface() = default;
  /// Sampled point of the surface.
  struct Sample {
    ShapePoint point;
    Vec2 uv;
    float weight;  ///< 1 / (area * density of the point per area); 1 if points are uniform over the area
  };
  /// Samples a point for a uniform `u` in [0, 1)^2.
  virtual Sample sample(Vec2 u) const = 0;
  /// Area of one side.
  virtual double area() const = 0;
  /// Bounds of its points and normals; one-sided.
  virtual LightBounds bounds() const = 0;
  /// True if rays can hit it. They cannot if alpha is 0: then all of its light comes from samples, as in pbrt-v4.
  virtual bool is_intersectable() const = 0;
  /// Factor by which alpha scales the light of a point that is hit or sampled.
  virtual float opacity(const EmittingPoint& at) const = 0;
};

/// Emission of an AreaLightSource directive; all surfaces that it applies to share its spectrum and image.
class AreaEmission {
 public:
  virtual ~AreaEmission() = default;
  /// True if each face of a shape becomes a light, as in pbrt-v4 if a total power is stated; else each shape does.
  virtual bool is_by_face() const = 0;
  /// Returns the light of a surface, not null. The area of the surface is above 0.
  virtual std::unique_ptr<AreaLight> make_area_light(std::unique_ptr<const EmittingSurface> surface) const = 0;
};

/// Plug-in record of an area light.
struct AreaLightInfo : PluginInfo {
  /// Returns an emission, not null. Throws InputError.
  std::unique_ptr<AreaEmission> (*make)(const Params&);
};

/// Light that surrounds the scene; every ray that leaves the scene meets it.
class EnvironmentLight : public Light {
 public:
  bool is_distant() const override { return true; }
  /// Radiance that arrives at `from` from `direction`, a unit vector toward the light.
  virtual SampledSpectrum radiance(const Vec3& from, const Vec3& direction, const SampledWavelengths& lambda) const = 0;
  /// Density of `sample` at `from` for `direction`, per solid angle.
  virtual float pdf(const Vec3& from, const Vec3& direction) const = 0;
  /// Density of `sample_compensated`, per solid angle.
  virtual float compensated_pdf(const Vec3& from, const Vec3& direction) const { return pdf(from, direction); }
};

}  // namespace frond
