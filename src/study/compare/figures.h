#pragma once

#include <string>

namespace frond::compare {

/// A number with so many significant figures, as people write it: 1230, not 1.23e+03.
std::string figures(double value, int count);

}  // namespace frond::compare
