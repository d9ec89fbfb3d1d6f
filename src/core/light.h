#pragma once

#include <optional>

#include "core/spectrum.h"
#include "core/vec.h"

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
