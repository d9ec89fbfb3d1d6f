#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// One chart of a report.
struct Chart {
  std::string name;         ///< of its files, without the ending
  std::string description;  ///< for those who do not see it
  std::string caption;
  std::string script;  ///< gnuplot's; empty: there is nothing to draw
  int width = 0, height = 0;
};

/// Error against time over all pixels and over leaves; then FLIP against time, or of bands error against wavelength.
std::vector<Chart> charts_of(const Comparison& comparison);

}  // namespace frond::compare
