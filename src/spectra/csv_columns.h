#pragma once

#include <string_view>
#include <vector>

namespace frond {

/// Returns the columns of an embedded table of numbers (data_files.h): lines of equally many values, separated by
/// commas. Lines that begin with # are skipped.
std::vector<std::vector<double>> csv_columns(std::string_view csv);

}  // namespace frond
