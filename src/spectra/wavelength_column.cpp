#include "spectra/wavelength_column.h"

#include <algorithm>
#include <array>

namespace frond {

bool names_wavelengths(std::string_view name) {
  constexpr std::array<std::string_view, 12> kNames{"wavelength", "wavelength_nm", "wavelengths", "nm",
                                                    "lambda",     "lambda_nm",     "wvl",         "wl",
                                                    "wave",       "waves",         "wavelen",     "sr_wl"};
  return std::ranges::find(kNames, name_without_unit(name)) != kNames.end();
}

std::optional<size_t> wavelength_column(const std::vector<TableField>& names) {
  const auto found = std::ranges::find_if(names, [](const TableField& f) { return names_wavelengths(f.text); });
  return found == names.end() ? std::nullopt : std::optional(size_t(found - names.begin()));
}

}  // namespace frond
