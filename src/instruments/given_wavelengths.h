#pragma once

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/wavelengths.h"

namespace frond {

/// Wavelength strategy with the same one to four wavelengths (nm) for every path and no film; lanes may be retired, as
/// by an integrator.
class GivenWavelengths final : public WavelengthStrategy {
 public:
  /// `retired`: indices of inactive lanes.
  explicit GivenWavelengths(std::vector<float> nm, const std::vector<size_t>& retired = {}) : nm_(std::move(nm)) {
    assert(!nm_.empty() && nm_.size() <= kLanes);
    lambda_.count = static_cast<int>(nm_.size());
    for (size_t i = 0; i < nm_.size(); ++i) {
      lambda_.nm[i] = nm_[i];
      lambda_.pdf[i] = 1;
      lambda_.active[i] = true;
    }
    for (const size_t lane : retired) lambda_.active[lane] = false;
  }

  SampledWavelengths sample(float) const override { return lambda_; }
  Interval range_nm() const override { return {*std::ranges::min_element(nm_), *std::ranges::max_element(nm_)}; }
  std::span<const float> fixed_nm() const override { return nm_; }
  SensorResponse sensor(const SampledSpectrum&, const SampledWavelengths&) const override { return {}; }
  std::string_view film_space() const override { return "XYZ"; }

 private:
  std::vector<float> nm_;
  SampledWavelengths lambda_;
};

}  // namespace frond
