#include "materials/table_wavelengths.h"

#include <algorithm>
#include <cmath>

#include "leaf/constants.h"

namespace frond {
namespace {

/// Whole multiples of the step, as far as leaves are known; the range lies between them.
std::vector<double> wavelengths(const WavelengthStrategy& strategy, double step_nm) {
  if (const auto fixed = strategy.fixed_nm(); !fixed.empty()) return {fixed.begin(), fixed.end()};
  const Interval range = strategy.range_nm(), known = leaf::kConstantsRange_nm;
  std::vector<double> grid;
  const auto first = static_cast<int>(std::floor(range.min / step_nm));
  const auto last = std::max(first + 1, static_cast<int>(std::ceil(range.max / step_nm)));
  for (int i = first; i <= last; ++i) grid.push_back(std::clamp(i * step_nm, known.min, known.max));
  return grid;
}

}  // namespace

std::vector<double> table_wavelengths(const WavelengthStrategy& strategy) { return wavelengths(strategy, 2.5); }

std::vector<double> index_wavelengths(const WavelengthStrategy& strategy) { return wavelengths(strategy, 40); }

}  // namespace frond
