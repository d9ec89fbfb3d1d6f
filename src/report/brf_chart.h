#pragma once

#include "radiometry/brf.h"
#include "report/chart.h"

namespace frond {

/// Views of one plane: the BRF against the zenith angle, a curve for each wavelength, with its standard errors.
Chart brf_plane_chart(const BrfMeasurement& measurement);
/// Views of a whole hemisphere, in rings of equal steps: a map for each wavelength with a patch for each view, seen
/// from above, the sun's side on the left.
Chart brf_hemisphere_chart(const BrfMeasurement& measurement);

}  // namespace frond
