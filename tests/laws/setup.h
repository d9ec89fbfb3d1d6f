#pragma once

#include <ostream>

#include "core/log.h"
#include "instruments/conformance/material_conformance.h"
#include "instruments/given_wavelengths.h"

namespace frond {

/// Prints a law in messages of failed tests.
inline void PrintTo(Law law, std::ostream* out) { *out << law_name(law); }

}  // namespace frond

namespace frond::test {

/// Of one examination. A file of some 50 examinations raises a false alarm at less than one in 20,000 changes of the
/// seed.
inline constexpr double kFalseAlarmRate = 1e-6;

/// Four wavelengths spread evenly over the visible, at a random place for each path.
class StratifiedWavelengths final : public WavelengthStrategy {
 public:
  SampledWavelengths sample(float u) const override {
    SampledWavelengths lambda;
    lambda.count = kLanes;
    for (size_t i = 0; i < kLanes; ++i) {
      lambda.nm[i] = 400 + 75 * (static_cast<float>(i) + u);
      lambda.pdf[i] = 1.f / 300;
      lambda.active[i] = true;
    }
    return lambda;
  }
  Interval range_nm() const override { return {400, 700}; }
  std::span<const float> fixed_nm() const override { return {}; }
  SensorResponse sensor(const SampledSpectrum&, const SampledWavelengths&) const override { return {}; }
  std::string_view film_space() const override { return "XYZ"; }
};

/// Arguments to prepare a material without a scene.
struct Setup {
  explicit Setup(const WavelengthStrategy& wavelengths) : preparation{wavelengths, pool, log, {}} {}

  ThreadPool pool{1};
  const Log& log = silent_log();
  Preparation preparation;
};

}  // namespace frond::test
