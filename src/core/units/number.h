#pragma once

#include <optional>
#include <string_view>

namespace frond {

/// Parses a decimal number as in scene files and PLY. Returns nullopt for other words ("nan", "inf", hexadecimal), and
/// infinity beyond the range of double.
std::optional<double> parse_number(std::string_view word);

}  // namespace frond
