#include "spectra/named_tables.h"

#include <charconv>
#include <stdexcept>
#include <string>

#include "spectra/cie.h"
#include "spectra/data_files.h"

namespace frond {
namespace {

/// Returns the text before the separator, and removes it and the separator from `text`.
std::string_view take_field(std::string_view& text, char separator) {
  const size_t end = text.find(separator);
  const std::string_view first = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return first;
}

/// Returns the index of a name in the line of column names that begins a block; 0, the index of "nm", if it is absent.
size_t index_of(std::string_view names, std::string_view name) {
  for (size_t i = 0; !names.empty(); ++i)
    if (take_field(names, ',') == name) return i;
  return 0;
}

/// Number in column `index` of a line.
double field(std::string_view line, size_t index) {
  for (size_t i = 0; i < index; ++i) take_field(line, ',');
  const std::string_view text = take_field(line, ',');
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::vector<SpectrumPoint> table_column(std::string_view csv, std::string_view name) {
  std::vector<SpectrumPoint> points;
  size_t column = 0;
  for (std::string_view rest = csv; !rest.empty();) {
    const std::string_view line = take_field(rest, '\n');
    if (line.empty() || line.front() == '#') continue;
    if (line.starts_with("nm,"))
      column = index_of(line, name);
    else if (column > 0)
      points.push_back({field(line, 0), field(line, column)});
  }
  if (points.empty()) throw std::logic_error("src/spectra/data has no column " + std::string(name));
  return points;
}

std::vector<SpectrumPoint> named_column(std::string_view name) { return table_column(named_csv, name); }

SpectrumPtr named_table(std::string_view name) {
  std::vector<SpectrumPoint> points = named_column(name);
  if (points.front().lambda_nm > kCieRange_nm.min)
    points.insert(points.begin(), {kCieRange_nm.min, points.front().value});
  if (points.back().lambda_nm < kCieRange_nm.max) points.push_back({kCieRange_nm.max, points.back().value});
  return make_tabulated(points);
}

}  // namespace frond
