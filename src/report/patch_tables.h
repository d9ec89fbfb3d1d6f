#pragma once

#include <string>

#include "instruments/goniophotometer.h"

namespace frond {

/// A goniophotometer's measurement, labelled with the material under test.
struct LabelledPatches {
  std::string material;
  GoniophotometerMeasurement measurement;
};

/// Returns the name of f in charts, with its unit.
inline std::string name_of_f(const GoniophotometerMeasurement& r, std::string_view of_light) {
  return r.fluorescence.empty() ? std::string(of_light) + " (sr⁻¹)" : "fluorescence (sr⁻¹ nm⁻¹)";
}

}  // namespace frond
