#include "study/compare/figures.h"

#include <fmt/format.h>

#include <cmath>

namespace frond::compare {

std::string figures(double value, int count) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{}", value);
  const double place = std::pow(10, std::floor(std::log10(std::abs(value))) + 1 - count);
  return fmt::format("{:.{}g}", std::round(value / place) * place, std::max(count, 6));
}

}  // namespace frond::compare
