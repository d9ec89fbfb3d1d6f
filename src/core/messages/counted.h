#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace frond {

/// Returns a number with its noun: "1 wavelength", "3 wavelengths". several: the plural, if it is not formed by -s.
template <class Number>
std::string counted(const Number& count, std::string_view one, std::string_view several = "") {
  if (count == Number(1)) return fmt::format("1 {}", one);
  return several.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, several);
}

}  // namespace frond
