#pragma once

#include "radiometry/brf.h"
#include "report/chart.h"

namespace frond {

/// Returns a chart of views in one plane: reflectance factor against zenith angle, one curve for each wavelength, with
/// standard errors.
Chart brf_plane_chart(const BrfMeasurement&);
/// Returns maps of views of a whole hemisphere in rings of equal steps: one map for each wavelength and one patch for
/// each view, seen from above with the sun's side on the left.
Chart brf_hemisphere_chart(const BrfMeasurement&);

}  // namespace frond
