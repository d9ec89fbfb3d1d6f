#include "spectra/wavelengths/registry.h"

#include <array>

namespace frond {

extern const WavelengthsInfo smpte_wavelengths;
extern const WavelengthsInfo hero_wavelengths;
extern const WavelengthsInfo meyer_wavelengths;
extern const WavelengthsInfo bands_wavelengths;

std::span<const WavelengthsInfo* const> builtin_wavelengths() {
  static constexpr std::array kAll{&smpte_wavelengths, &hero_wavelengths, &meyer_wavelengths, &bands_wavelengths};
  return kAll;
}

}  // namespace frond
