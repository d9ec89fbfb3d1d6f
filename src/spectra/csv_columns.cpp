#include "spectra/csv_columns.h"

#include <algorithm>
#include <charconv>

namespace frond {

std::vector<std::vector<double>> csv_columns(std::string_view csv) {
  std::vector<std::vector<double>> columns;
  while (!csv.empty()) {
    const std::string_view line = csv.substr(0, csv.find('\n'));
    csv.remove_prefix(std::min(csv.size(), line.size() + 1));
    if (line.empty() || line.front() == '#') continue;
    const char* const end = line.data() + line.size();
    size_t column = 0;
    for (const char* at = line.data(); at < end; ++at, ++column) {
      double value = 0;
      at = std::from_chars(at, end, value).ptr;
      if (column == columns.size()) columns.emplace_back();
      columns[column].push_back(value);
    }
  }
  return columns;
}

}  // namespace frond
