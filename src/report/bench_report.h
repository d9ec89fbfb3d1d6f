#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "instruments/sample_worth.h"
#include "report/chart.h"

namespace frond {

/// What is timed. hit: the BSDF is made, its density and value toward a light are asked for, and a ray is scattered.
enum class BsdfCall { sample, f, pdf, hit };
inline constexpr std::array<std::string_view, 4> kBsdfCalls{"sample", "f", "pdf", "hit"};

/// The measurements of a material seen from one direction with so many wavelengths.
struct BenchMeasurement {
  std::string material;  ///< its text
  double theta_deg = 0;
  int lanes = 1;
  std::array<Estimate, kBsdfCalls.size()> time_ns;  ///< CPU time of a call, by BsdfCall
  SampleWorth worth;

  const Estimate& time(BsdfCall call) const { return time_ns[static_cast<size_t>(call)]; }
};

/// Relative variance of the lit planes against the time of a hit, at the largest number of
/// wavelengths; a colour for each material, a mark for each angle, lines where time x variance is the same.
Chart bench_chart(const std::vector<BenchMeasurement>& measurements);
/// Throws InputError for more materials or angles than that chart can tell apart.
void check_bench_chart(size_t materials, size_t angles);

}  // namespace frond
