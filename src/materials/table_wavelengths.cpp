#include "materials/table_wavelengths.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"
#include "spectra/check_range.h"

namespace frond {
namespace {

std::vector<double> to_vector(std::span<const float> nm) { return {nm.begin(), nm.end()}; }

/// Multiples of the step that enclose `range`, clamped to the range of the optical constants.
std::vector<double> even_wavelengths(const Interval& range, double step_nm) {
  const Interval known = leaf::kConstantsRange_nm;
  std::vector<double> grid;
  const auto first = static_cast<int>(std::floor(range.min / step_nm));
  const auto last = std::max(first + 1, static_cast<int>(std::ceil(range.max / step_nm)));
  for (int i = first; i <= last; ++i) grid.push_back(std::clamp(i * step_nm, known.min, known.max));
  return grid;
}

bool reaches(Interval data_nm, Interval needed_nm) {
  return data_nm.contains(needed_nm.min) && data_nm.contains(needed_nm.max);
}

/// As check_range, with a hint at wavelengths that the file covers: most files do not cover the whole spectrum.
void check_file_range(Interval in_file_nm, const WavelengthStrategy& strategy, const Location& where,
                      std::string_view name) {
  const Interval needed_nm = strategy.range_nm();
  if (needed_nm.min < needed_nm.max && !reaches(in_file_nm, needed_nm)) {
    // Beyond `seen_nm` lie at most 3.2 % of the integral of a colour matching function under D65. The SMPTE wavelengths
    // are 455, 551 and 608 nm.
    constexpr Interval seen_nm{420, 680}, smpte_nm{455, 608};
    const auto reject = [&](const std::string& hint) {
      fail(where, "\"{}\" is known from {} to {} nm, the render needs {} to {} nm; {}", name, in_file_nm.min,
           in_file_nm.max, needed_nm.min, needed_nm.max, hint);
    };
    if (reaches(in_file_nm, seen_nm))
      reject(fmt::format("--wavelengths hero,lambdamin={},lambdamax={} leaves out what the file lacks",
                         std::max(in_file_nm.min, needed_nm.min), std::min(in_file_nm.max, needed_nm.max)));
    if (reaches(in_file_nm, smpte_nm)) reject("--wavelengths smpte renders 608, 551 and 455 nm");
  }
  check_range(in_file_nm, strategy, where, name);
}

}  // namespace

std::vector<double> table_wavelengths(const WavelengthStrategy& strategy) {
  if (!strategy.fixed_nm().empty()) return to_vector(strategy.fixed_nm());
  if (!strategy.listed_nm().empty()) return to_vector(strategy.listed_nm());
  return even_wavelengths(strategy.range_nm(), 2.5);
}

std::vector<double> file_wavelengths(std::vector<double> in_file_nm, const WavelengthStrategy& strategy,
                                     const Location& where, std::string_view name) {
  // A file of one wavelength is constant over the spectrum.
  const bool grey = in_file_nm.size() == 1;
  std::ranges::sort(in_file_nm);
  if (!grey) check_file_range({in_file_nm.front(), in_file_nm.back()}, strategy, where, name);
  if (!strategy.fixed_nm().empty()) return to_vector(strategy.fixed_nm());
  const Interval needed = strategy.range_nm();
  // A look-up interpolates between two wavelengths at least.
  return grey ? std::vector{needed.min, needed.max + 1} : in_file_nm;
}

// Strategies with one range share tables even if they draw wavelengths differently.
std::string wavelengths_key(const WavelengthStrategy& strategy) {
  if (!strategy.fixed_nm().empty()) return fmt::format("fixed wavelengths {}\n", fmt::join(strategy.fixed_nm(), " "));
  const Interval range = strategy.range_nm();
  return fmt::format("varying wavelengths {} to {}\n", range.min, range.max);
}

std::vector<double> index_wavelengths(const WavelengthStrategy& strategy) {
  if (!strategy.fixed_nm().empty()) return to_vector(strategy.fixed_nm());
  return even_wavelengths(strategy.range_nm(), 40);
}

leaf::DepthAxis depth_axis(const leaf::DepthMap& depth, const WavelengthStrategy& strategy, double step) {
  Interval all{std::numeric_limits<double>::infinity(), 0};
  const auto include = [&](double nm) {
    const Interval range = depth.range(nm);
    all = {std::min(all.min, range.min), std::max(all.max, range.max)};
  };
  for (const float nm : strategy.fixed_nm()) include(static_cast<double>(nm));
  if (!strategy.fixed_nm().empty()) return {all.min, all.max, step};
  // Linear between the nodes of the absorption's grid: extremes lie there or at the ends.
  const Interval range = strategy.range_nm();
  include(range.min), include(range.max);
  for (size_t i = 0; i < leaf::kAbsorptionGrid.size(); ++i)
    if (range.contains(leaf::kAbsorptionGrid.nm(i))) include(leaf::kAbsorptionGrid.nm(i));
  return {all.min, all.max, step};
}

}  // namespace frond
