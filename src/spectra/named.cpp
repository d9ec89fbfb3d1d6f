#include "spectra/named.h"

#include <algorithm>

#include "spectra/cie.h"
#include "spectra/glasses.h"
#include "spectra/illuminants.h"
#include "spectra/named_tables.h"
#include "spectra/solar.h"

namespace frond {
namespace {

/// Name of a spectrum that a function returns.
struct Named {
  std::string_view name;
  SpectrumPtr (*get)();
};
constexpr Named kNamed[] = {{"glass-BAF10", glass_baf10},
                            {"glass-BK7", glass_bk7},
                            {"glass-F10", glass_sf10},
                            {"glass-F11", glass_sf11},
                            {"glass-F5", glass_sf5},
                            {"glass-FK51A", glass_fk51a},
                            {"glass-LASF9", glass_lasf9},
                            {"glass-SF10", glass_sf10},
                            {"glass-SF11", glass_sf11},
                            {"glass-SF5", glass_sf5},
                            {"illum-acesD60", aces_d60},
                            {"solar-am0", solar_am0},
                            {"solar-am1.5-direct", solar_am15_direct},
                            {"solar-am1.5-global", solar_am15_global},
                            {"stdillum-A", illuminant_a},
                            {"stdillum-D50", d50},
                            {"stdillum-D55", d55},
                            {"stdillum-D65", d65},
                            {"stdillum-D75", d75},
                            {"stdillum-E", illuminant_e}};

/// Names of columns of src/spectra/data/named.csv.
constexpr std::string_view kTables[] = {
    "metal-Ag-eta", "metal-Ag-k",     "metal-Al-eta", "metal-Al-k",    "metal-Au-eta", "metal-Au-k",     "metal-Cu-eta",
    "metal-Cu-k",   "metal-CuZn-eta", "metal-CuZn-k", "metal-MgO-eta", "metal-MgO-k",  "metal-TiO2-eta", "metal-TiO2-k",
    "stdillum-F1",  "stdillum-F2",    "stdillum-F3",  "stdillum-F4",   "stdillum-F5",  "stdillum-F6",    "stdillum-F7",
    "stdillum-F8",  "stdillum-F9",    "stdillum-F10", "stdillum-F11",  "stdillum-F12"};

}  // namespace

std::vector<std::string_view> spectrum_names() {
  std::vector<std::string_view> names(std::begin(kTables), std::end(kTables));
  for (const Named& n : kNamed) names.push_back(n.name);
  std::ranges::sort(names);
  return names;
}

SpectrumPtr named_spectrum(std::string_view name, const Location& where) {
  for (const Named& n : kNamed)
    if (n.name == name) return n.get();
  if (std::ranges::find(kTables, name) != std::end(kTables)) return named_table(name);
  const auto names = spectrum_names();
  fail(where, "unknown spectrum \"{}\"{}, or a .spd file", name, suggestion(name, names));
}

}  // namespace frond
