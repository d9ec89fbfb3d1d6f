#include "materials/table_wavelengths.h"

#include <cmath>

namespace frond {

std::vector<double> table_wavelengths(const WavelengthStrategy& strategy) {
  constexpr double kStep_nm = 2.5;
  if (const auto fixed = strategy.fixed_nm(); !fixed.empty()) return {fixed.begin(), fixed.end()};
  const Interval range = strategy.range_nm();
  std::vector<double> grid;
  const auto first = static_cast<int>(std::floor(range.min / kStep_nm));
  const auto last = std::max(first + 1, static_cast<int>(std::ceil(range.max / kStep_nm)));
  for (int i = first; i <= last; ++i) grid.push_back(i * kStep_nm);
  return grid;
}

}  // namespace frond
