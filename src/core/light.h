#pragma once

#include <memory>
#include <optional>

#include "core/plugin.h"
#include "core/shape.h"
#include "core/spectrum.h"
#include "core/transform.h"

namespace frond {

struct LightSample {
  SampledSpectrum radiance;  ///< W/(m^2 sr nm) before film scaling; for a delta light: irradiance over cosine
  Vec3 wi;                   ///< from the point toward the light, unit
  float distance = 0;        ///< infinity for lights outside the scene
  float pdf = 0;             ///< per solid angle at the point; 1 for a delta light
};

/// Where a light is, and where it shines.
struct LightBounds {
  Vec3 min, max;
  Vec3 axis{0, 0, 1};      ///< unit: about the middle of the directions that it faces
  float cos_spread = -1;   ///< it faces directions up to this angle from the axis: -1 for all
  float cos_reach = 0;     ///< and shines up to this angle from a direction that it faces, most along it
  bool two_sided = false;  ///< the same the other way round
};

/// Something that lights points of the scene.
class Light {
 public:
  virtual ~Light() = default;
  virtual std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const = 0;
  /// Samples of a light may compete with scattered rays that meet it, and then leave out what those find as well: the
  /// share of its power that is left in. 0: it is left to scattered rays.
  virtual double competing_share() const { return 1; }
  /// The same as `sample`, but for what is left out.
  virtual std::optional<LightSample> sample_competing(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const {
    return sample(p, u, lambda);
  }
  /// Light through a point or from one direction: no ray meets it by chance.
  virtual bool is_delta() const = 0;
  /// From outside the scene: the same at all of its points.
  virtual bool is_distant() const { return false; }
  /// Photometric power up to a factor common to all lights of a scene of the given radius: how often to choose it.
  virtual double power(float scene_radius) const = 0;
  /// To choose by what reaches a point. Nothing: from everywhere, or it is not known.
  virtual std::optional<LightBounds> bounds() const { return {}; }
  /// Spectrum of what it gives off, up to a factor; of an image's, that of its white.
  virtual const Spectrum& emission() const = 0;
  /// Wavelengths (nm) for which the emission is known.
  Interval range_nm() const { return emission().range_nm(); }

  /// Place in the scene's list of lights.
  int index() const { return index_; }
  void set_index(int index) { index_ = index; }

 private:
  int index_ = 0;
};

struct LightInfo : PluginInfo {
  std::unique_ptr<Light> (*make)(const Params&, const Transform& world_from_light);
};

template <class T>
std::unique_ptr<Light> make_light(const Params& p, const Transform& world_from_light) {
  return std::make_unique<T>(p, world_from_light);
}

/// A point of a surface that gives off light.
struct EmittingPoint {
  Vec3 p;   ///< world space
  Vec3 ng;  ///< geometric normal, unit, on the front
  Vec2 uv;  ///< of the surface
};

/// Light given off by a surface of the scene.
class AreaLight : public Light {
 public:
  /// Radiance that leaves the point along `w`.
  virtual SampledSpectrum radiance(const EmittingPoint& at, const Vec3& w, const SampledWavelengths& lambda) const = 0;
  /// Density of `sample` at `from`, per solid angle at that point, for a point of the surface.
  virtual float pdf(const Vec3& from, const EmittingPoint& at) const = 0;
};

/// Points over the area of a shape that gives off light, or of one of its faces, in world space.
class EmittingSurface {
 public:
  virtual ~EmittingSurface() = default;
  struct Sample {
    ShapePoint point;
    Vec2 uv;
    float weight;  ///< 1 / area over the density: 1 where points are evenly spread over the area
  };
  virtual Sample sample(Vec2 u) const = 0;
  /// Of one side.
  virtual double area() const = 0;
  /// Of its points and normals; one-sided.
  virtual LightBounds bounds() const = 0;
  /// Whether rays can meet it. With an alpha of 0 they never do: all of its light comes from samples, as in pbrt-v4.
  virtual bool is_met() const = 0;
  /// Share of the light that alpha leaves of what is met or sampled there.
  virtual float opacity(const EmittingPoint& at) const = 0;
};

/// An AreaLightSource: what it says of any number of surfaces, which share its spectrum and image.
class AreaEmission {
 public:
  virtual ~AreaEmission() = default;
  /// Each face of a shape is a light of its own, as in pbrt-v4 where a total is stated.
  virtual bool is_by_face() const = 0;
  /// Not null. The surface has an area above 0.
  virtual std::unique_ptr<AreaLight> over(std::unique_ptr<const EmittingSurface> surface) const = 0;
};

struct AreaLightInfo : PluginInfo {
  std::unique_ptr<AreaEmission> (*make)(const Params&);
};

/// Light from outside the scene, met by every ray that leaves it.
class EnvironmentLight : public Light {
 public:
  bool is_distant() const override { return true; }
  /// What arrives at `from` from the direction.
  virtual SampledSpectrum radiance(const Vec3& from, const Vec3& direction, const SampledWavelengths& lambda) const = 0;
  /// Density of `sample` there, per solid angle.
  virtual float pdf(const Vec3& from, const Vec3& direction) const = 0;
  /// That of `sample_competing`.
  virtual float competing_pdf(const Vec3& from, const Vec3& direction) const { return pdf(from, direction); }
};

}  // namespace frond
