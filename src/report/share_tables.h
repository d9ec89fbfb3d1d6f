#pragma once

#include <array>
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

/// Returns a panel of reflectance and, below it, one of transmittance.
std::array<Panel, 2> shares_panels(const std::string& x_label);
/// Sets the range of both, from 0 to the largest share: R and T are compared.
void set_range_of(std::array<Panel, 2>& panels);

/// Returns a chart of reflectance and transmittance. The x axis is wavelength or angle, whichever has more values;
/// there is a curve for each material and each value of the other. Throws InputError if neither varies, or for more
/// curves than colours.
Chart shares_chart(const std::vector<LabelledMeasurement>& measurements);

/// Throws as shares_chart does; called before the measurement.
void check_shares_chart(size_t materials, size_t angles, size_t wavelengths);

}  // namespace frond
