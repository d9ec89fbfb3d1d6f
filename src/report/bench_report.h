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

/// Returns the CPU time in us until the standard error is 1 % of the mean; infinite if the mean is 0.
double us_to_percent(const Worth& worth, double variance, const Estimate& time_ns);

/// Returns a chart of the time of hits until the standard error of the lit planes is 1 %, at least the time of one hit,
/// at the largest number of wavelengths: one row for each material, one mark for each angle.
Chart bench_chart(const std::vector<BenchMeasurement>& measurements);
/// Throws InputError for more materials or angles than the chart has rows or marks.
void check_bench_chart(size_t materials, size_t angles);

}  // namespace frond
