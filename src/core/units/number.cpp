#include "core/units/number.h"

#include <charconv>
#include <cstdlib>
#include <string>

namespace frond {

/// std::from_chars is independent of the locale, unlike strtod.
std::optional<double> parse_number(std::string_view word) {
  const size_t signs = word.starts_with('+') || word.starts_with('-') ? 1 : 0;
  const char first = word.size() > signs ? word[signs] : '\0';
  if (first != '.' && (first < '0' || first > '9')) return {};  // from_chars would accept "nan" and "inf"
  if (word[0] == '+') word.remove_prefix(1);                    // from_chars rejects a plus sign
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return {};
  if (error == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
  return value;
}

}  // namespace frond
