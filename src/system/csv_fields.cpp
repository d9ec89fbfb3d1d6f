#include "system/csv_fields.h"

#include <algorithm>
#include <charconv>

namespace frond {
namespace {

/// Returns the index behind a field that begins at `begin`.
size_t end_of_field(std::string_view line, size_t begin, char separator) {
  if (begin < line.size() && line[begin] == '"')
    if (const size_t quote = line.find('"', begin + 1); quote != line.npos) begin = quote + 1;
  return std::min(line.find(separator, begin), line.size());
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\"";
  const size_t begin = text.find_first_not_of(kSpace);
  return begin == text.npos ? std::string_view() : text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

std::vector<CsvField> split_fields(std::string_view line, char separator, Location where) {
  std::vector<CsvField> fields;
  for (size_t begin = 0; begin <= line.size();) {
    if (separator == ' ') begin = std::min(line.find_first_not_of(" \r", begin), line.size());
    const size_t end = end_of_field(line, begin, separator);
    where.column = static_cast<int>(begin) + 1;
    if (separator != ' ' || end > begin) fields.push_back({trimmed(line.substr(begin, end - begin)), where});
    begin = end + 1;
  }
  return fields;
}

std::optional<double> field_number(std::string_view text, char separator) {
  std::string plain(text);
  if (separator != ',') std::ranges::replace(plain, ',', '.');
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc() || end != plain.data() + plain.size()) return {};
  return value;
}

}  // namespace frond
