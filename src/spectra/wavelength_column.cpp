#include "spectra/wavelength_column.h"

#include <algorithm>
#include <array>
#include <map>

namespace frond {

bool names_wavelengths(std::string_view name) {
  constexpr std::array<std::string_view, 12> kNames{"wavelength", "wavelength_nm", "wavelengths", "nm",
                                                    "lambda",     "lambda_nm",     "wvl",         "wl",
                                                    "wave",       "waves",         "wavelen",     "sr_wl"};
  return std::ranges::find(kNames, name_without_unit(name)) != kNames.end();
}

bool is_in_micrometres(std::string_view name) {
  const std::string unit = lower_case(name.substr(std::min(name.find_first_of("([/"), name.size())));
  return unit.find("um") != unit.npos || unit.find("\u00b5m") != unit.npos || unit.find("\u03bcm") != unit.npos ||
         unit.find("micro") != unit.npos;
}

std::optional<size_t> wavelength_column(const std::vector<TableField>& names) {
  const auto found = std::ranges::find_if(names, [](const TableField& f) { return names_wavelengths(f.text); });
  return found == names.end() ? std::nullopt : std::optional(size_t(found - names.begin()));
}

WavelengthNames wavelength_names(const std::vector<TableField>& names) {
  std::map<std::string, WavelengthNames> by_prefix;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(names[i].text);
    const size_t begin = std::min(name.find_first_of("0123456789"), name.size());
    const size_t end = std::min(name.find_first_not_of("0123456789.", begin), name.size());
    const std::string nm = name.substr(begin, end - begin), after = name.substr(end);
    if (nm.empty() || (!after.empty() && after != "nm" && after != "_nm" && after != " nm")) continue;
    WavelengthNames& found = by_prefix[name.substr(0, begin)];
    found.columns.push_back(i), found.nm.push_back(nm);
  }
  constexpr size_t kLeast = 5;
  WavelengthNames most;
  for (auto& [prefix, found] : by_prefix)
    if (found.columns.size() >= kLeast && found.columns.size() > most.columns.size()) most = std::move(found);
  return most;
}

}  // namespace frond
