#pragma once

#include <optional>
#include <span>
#include <vector>

#include "radiometry/brf.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/path_pairs.h"

namespace frond {

/// Samples the light that enters a scene from its sun and sky, in proportion to the irradiance on a horizontal plane.
class IncidentLight {
 public:
  /// `lambda`: wavelengths at which the scene has light.
  IncidentLight(const Scene& scene, HorizontalIrradiance irradiance, const SampledWavelengths& lambda);

  struct Sample {
    Vec3 direction;                   ///< direction of propagation, downward unless it is that of a lamp
    SampledSpectrum weight;           ///< mean 1
    bool is_direct = false;           ///< as frond::is_direct; light of lamps is not
    std::optional<Vec3> origin = {};  ///< of light of a lamp in the scene
    UnitPoint place{};                ///< uniform, for the place where light from outside enters
  };
  /// Returns a direction of one of the lights; nullopt if the sample fails. `place`: uniform; each light has a strip of
  /// the square, which is mapped to its places: `Sample::place`, or the points of a lamp.
  std::optional<Sample> sample(UnitPoint place, RandomStream& random, const SampledWavelengths& lambda) const;

 private:
  std::span<const Light* const> lights_;
  std::vector<const EnvironmentLight*> cosine_sampled_;  ///< by light; nullptr: the light samples itself
  HorizontalIrradiance irradiance_;
};

/// Faces through which light enters: the target, and perhaps the sides of the box below it.
struct EntryBox {
  Target target;
  std::optional<double> bottom = {};  ///< z of the lower ends of the sides; nullopt: light enters through the target

  double target_area() const { return (target.x1 - target.x0) * (target.y1 - target.y0); }

  struct Point {
    Vec3d p;           ///< in the coordinates of the scene file
    float weight = 1;  ///< area of the faces over that of the target, both projected along the direction
  };
  /// Returns a point, uniform over the projected faces, for light that propagates along `d`, downward. `u`: uniform.
  Point sample(const Vec3d& d, UnitPoint u) const;
};

}  // namespace frond
