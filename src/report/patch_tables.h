#pragma once

#include <string>

#include "instruments/goniophotometer.h"

namespace frond {

/// A goniophotometer's measurement, labelled with the material under test.
struct LabelledPatches {
  std::string material;
  GoniophotometerMeasurement measurement;
};

}  // namespace frond
