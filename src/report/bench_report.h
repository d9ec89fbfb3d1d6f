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

/// What `frond bench` finds out about a material seen from one direction with so many wavelengths.
struct BenchReading {
  std::string material;  ///< the words of the command line
  double theta_deg = 0;
  int lanes = 1;
  std::array<Estimate, kBsdfCalls.size()> time_ns;  ///< CPU time of a call, by BsdfCall
  SampleWorth worth;

  const Estimate& time(BsdfCall call) const { return time_ns[static_cast<size_t>(call)]; }
};

/// CPU seconds until the standard error is 1 % of the mean; infinite where the mean is 0.
double seconds_to_percent(const Worth& worth, const Estimate& time_ns);

/// For people: a table of times and one of what samples are worth for each material.
std::string bench_text(const std::vector<BenchReading>& readings);

/// Relative variance of the lit planes against the time of a hit, at the largest number of
/// wavelengths; a colour for each material, a mark for each angle, lines where time x variance is the same.
Chart bench_chart(const std::vector<BenchReading>& readings);
/// Throws InputError for more materials or angles than that chart can tell apart.
void check_bench_chart(size_t materials, size_t angles);

}  // namespace frond
