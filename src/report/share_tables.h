#pragma once

#include <string>
#include <vector>

#include "instruments/spectrophotometer.h"
#include "report/chart.h"

namespace frond {

/// A spectrophotometer's measurement, labelled with the material under test.
struct LabelledMeasurement {
  std::string material;
  SpectrophotometerMeasurement measurement;
};

/// Returns a panel with axes of R from below and T from above, each from 0 to 1.
Panel shares_panel(std::string x_label);

/// Returns a chart of reflectance from below and transmittance from above, the convention for leaves: the area between
/// them is absorbed. The x axis is wavelength or angle, whichever has more values; there is a colour for each material
/// and each value of the other. Throws InputError if neither varies, or for more curves than colours.
Chart shares_chart(const std::vector<LabelledMeasurement>& measurements);

/// Throws as shares_chart does; called before the measurement.
void check_shares_chart(size_t materials, size_t angles, size_t wavelengths);

}  // namespace frond
