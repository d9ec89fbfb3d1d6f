#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace frond {

/// Angular distribution of a sky's radiance, without unit and the same for all wavelengths: a gradation from zenith to
/// horizon times an indicatrix, a function of the angle gamma to the sun. Neither is negative.
///
///   (1 + a exp(b / cos zenith)) (1 + c (exp(d gamma) - offset) + e cos^2 gamma)
struct SkyShape {
  float a, b;
  float c, d, e;  ///< d: 1/rad
  float offset = 0;

  /// Returns the relative radiance of a direction above the horizon. `sun_angle`: gamma, rad.
  float radiance(float cos_zenith, float sun_angle) const {
    const float cos_gamma = std::cos(sun_angle);
    const float gradation = 1 + a * std::exp(b / cos_zenith);
    const float indicatrix = 1 + c * (std::exp(d * sun_angle) - offset) + e * cos_gamma * cos_gamma;
    return std::max(0.f, gradation) * std::max(0.f, indicatrix);
  }
};

/// Returns the all-weather sky of Perez, Seals and Michalsky (1993) for a zenith angle of the sun below 90 degrees. The
/// irradiances are those of the whole spectrum: of the sun on a plane that faces it, and of the sky on a horizontal
/// plane (above 0), W/m^2.
///
/// Two limits are not in the paper. b is at most 0: above, the horizon's radiance would be infinite. The brightness is
/// at least 0.2 if the clearness is from 1.065 to 2.8, as in Radiance's gendaylit: below, which occurs for a sun within
/// 5 degrees of the horizon, the paper's radiance is negative in parts of the sky.
SkyShape perez_sky(double sun_zenith_deg, double direct_normal, double diffuse);

inline constexpr int kCieSkies = 15;

/// Returns a sky of the CIE Standard General Sky (ISO 15469:2004); `type` from 1 to kCieSkies.
SkyShape cie_sky(int type);

}  // namespace frond
