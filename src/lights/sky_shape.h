#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/vec.h"

namespace frond {

/// Angular distribution of a sky's radiance, without unit and the same for all wavelengths: a gradation from zenith to
/// horizon times an indicatrix, a function of the angle gamma to the sun. Neither is negative.
///
///   (1 + a exp(b / cos zenith)) (1 + c (exp(d gamma) - offset) + e cos^2 gamma)
struct SkyShape {
  float a, b;
  float c, d, e;  ///< d: 1/rad
  float offset = 0;

  /// Returns the gradation at a cosine of the zenith angle in [0, 1].
  float gradation(float cos_zenith) const {
    const float at_horizon = b < 0 ? 0.f : 1.f;
    return std::max(0.f, 1 + a * (cos_zenith > 0 ? std::exp(b / cos_zenith) : at_horizon));
  }
  /// Returns the indicatrix. `sun_angle`: gamma, rad.
  float indicatrix(float sun_angle) const {
    const float cosine = std::cos(sun_angle);
    return std::max(0.f, 1 + c * (std::exp(d * sun_angle) - offset) + e * cosine * cosine);
  }
  /// Returns the relative radiance of a direction above the horizon.
  float radiance(float cos_zenith, float sun_angle) const { return gradation(cos_zenith) * indicatrix(sun_angle); }
};

/// Tables of a shape, for evaluation without transcendental functions; within 1e-3 of it.
class SkyTables {
 public:
  explicit SkyTables(const SkyShape& shape);
  /// Returns the relative radiance of a direction above the horizon. `distance2`: squared distance of its unit vector
  /// from that toward the sun.
  float radiance(float cos_zenith, float distance2) const {
    return at(gradation_, cos_zenith) * at(indicatrix_, std::sqrt(distance2) / 2);
  }

 private:
  static constexpr int kCells = 1024;
  using Table = std::array<float, kCells + 1>;
  /// Interpolates linearly; `x` in [0, 1], except for rounding.
  static float at(const Table& table, float x) {
    const float place = std::min(x, 1.f) * kCells;
    const auto i = std::min(size_t(place), size_t(kCells - 1));
    return table[i] + (place - float(i)) * (table[i + 1] - table[i]);
  }

  Table gradation_;   ///< over the cosine of the zenith angle
  Table indicatrix_;  ///< over half the distance
};

/// Returns the all-weather sky of Perez, Seals and Michalsky (1993) for a zenith angle of the sun below 90 degrees. The
/// irradiances are integrals over the whole spectrum: of the sun on a plane that faces it, and of the sky on a
/// horizontal plane (above 0), W/m^2.
///
/// Two limits are not in the paper. b is at most 0: above, the horizon's radiance would be infinite. The brightness is
/// at least 0.2 if the clearness is from 1.065 to 2.8, as in Radiance's gendaylit: below, which occurs for a sun within
/// 5 degrees of the horizon, the paper's radiance is negative in parts of the sky.
SkyShape perez_sky(double sun_zenith_deg, double direct_normal, double diffuse);

inline constexpr int kCieSkies = 15;

/// Returns a sky of the CIE Standard General Sky (ISO 15469:2004); `type` from 1 to kCieSkies.
SkyShape cie_sky(int type);

}  // namespace frond
