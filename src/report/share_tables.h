#pragma once

#include <string>
#include <vector>

#include "instruments/spectrophotometer.h"
#include "report/chart.h"

namespace frond {

/// A spectrophotometer's measurement and the material under test.
struct LabelledMeasurement {
  std::string material;
  SpectrophotometerMeasurement measurement;
};

/// Axes of R from below and T from above, each from 0 to 1.
Panel shares_panel(std::string x_label);

/// Reflectance from below and transmittance from above, as is usual for leaves, so that what lies
/// between is absorbed. Against wavelength or angle, whichever has more values; a colour for each material and each
/// value of the other. Throws InputError where there is nothing to plot against, or there are more curves than colours.
Chart shares_chart(const std::vector<LabelledMeasurement>& measurements);

/// Throws as shares_chart does, before anything is measured.
void check_shares_chart(size_t materials, size_t angles, size_t wavelengths);

}  // namespace frond
