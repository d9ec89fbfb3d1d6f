#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "instruments/sample_worth.h"
#include "report/chart.h"

namespace frond {

/// Timed operation. hit: create the BSDF, evaluate its value and density toward a light, and sample a direction.
enum class BsdfCall { sample, f, pdf, hit };
inline constexpr std::array<std::string_view, 4> kBsdfCalls{"sample", "f", "pdf", "hit"};

/// Measurements of a material, seen from one direction, with `lanes` wavelengths.
struct BenchMeasurement {
  std::string material;  ///< name and parameters
  double theta_deg = 0;
  int lanes = 1;
  std::array<Estimate, kBsdfCalls.size()> time_ns;  ///< CPU time of a call, by BsdfCall
  SampleWorth worth;

  const Estimate& time(BsdfCall call) const { return time_ns[static_cast<size_t>(call)]; }
};

/// Returns a chart of the relative variance of the lit planes against the time of a hit, at the largest number of
/// wavelengths: one colour for each material, one mark for each angle, lines of constant time x variance.
Chart bench_chart(const std::vector<BenchMeasurement>& measurements);
/// Throws InputError for more materials or angles than the chart has colours or marks.
void check_bench_chart(size_t materials, size_t angles);

}  // namespace frond
