#pragma once

#include <string>

#include "radiometry/brf.h"

namespace frond {

/// A chart as write_chart takes it.
struct BrfChart {
  std::string script;
  int width, height;
};

/// Views of one plane: the BRF against the zenith angle, a curve for each wavelength, with its standard errors.
BrfChart brf_plane_chart(const BrfReading& reading);
/// Views of a whole hemisphere: a map for each wavelength, seen from above, the sun's side on the left.
BrfChart brf_hemisphere_chart(const BrfReading& reading);

}  // namespace frond
