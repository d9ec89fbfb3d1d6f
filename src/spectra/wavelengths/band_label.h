#pragma once

#include <fmt/format.h>

#include <string>

#include "core/wavelengths.h"

namespace frond {

/// Returns what texts and charts call a band: its name, or its wavelength, as in "550 nm".
inline std::string label_of(const Band& band) {
  return band.name.empty() ? fmt::format("{:g} nm", band.nm) : band.name;
}

/// Returns how a sentence names a band: "at 550 nm", or "in band nir".
inline std::string place_of(const Band& band) {
  return band.name.empty() ? fmt::format("at {:g} nm", band.nm) : fmt::format("in band {}", band.name);
}

}  // namespace frond
