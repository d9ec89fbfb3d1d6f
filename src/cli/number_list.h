#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace frond {

/// Numbers as a command line lists them: `8`, `0,8,30`, `0:180:1` (first:last:step, both ends), or ranges among
/// numbers: `0:80:10,85,89`. Throws InputError that names `option` and shows the forms.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);

/// A whole number of things that may be written 1e6. Throws InputError unless it is from `least` to 2^53.
int64_t parse_count(const std::string& option, const std::string& text, int64_t least);

/// Two whole numbers, as in `20x40`.
std::pair<int, int> parse_product(const std::string& option, const std::string& text);

}  // namespace frond
