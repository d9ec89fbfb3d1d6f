#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace frond {

/// A number as scene files write them, unless it is too large for a double.
std::optional<double> finite_number(std::string_view text);

/// Numbers as a command line lists them: `8`, `0,8,30`, `0:180:1` (first:last:step, both ends), or ranges among
/// numbers: `0:80:10,85,89`. Throws InputError that names `option` and shows the forms.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);

/// Up to it, every whole number is a double.
inline constexpr int64_t kMostCount = int64_t{1} << 53;

/// A whole number of things that may be written 1e6. Throws InputError unless it is from `least` to `most`.
int64_t parse_count(const std::string& option, const std::string& text, int64_t least, int64_t most = kMostCount);

/// Two whole numbers, as in `20x40`.
std::pair<int, int> parse_product(const std::string& option, const std::string& text);

}  // namespace frond
