#include "spectra/named.h"

#include <fmt/ranges.h>

#include "spectra/cie.h"
#include "spectra/illuminants.h"
#include "spectra/solar.h"

namespace frond {
namespace {

struct Named {
  std::string_view name;
  SpectrumPtr (*get)();
};
constexpr Named kNamed[] = {{"solar-am0", solar_am0},
                            {"solar-am1.5-direct", solar_am15_direct},
                            {"solar-am1.5-global", solar_am15_global},
                            {"stdillum-A", illuminant_a},
                            {"stdillum-D65", d65},
                            {"stdillum-E", illuminant_e}};

/// Families of names that pbrt-v4 has built in.
bool is_known_to_pbrt(std::string_view name) {
  constexpr std::string_view families[] = {"glass-", "metal-", "stdillum-", "illum-"};
  return std::any_of(std::begin(families), std::end(families), [&](auto f) { return name.starts_with(f); });
}

}  // namespace

std::vector<std::string_view> spectrum_names() {
  std::vector<std::string_view> names;
  for (const Named& n : kNamed) names.push_back(n.name);
  return names;
}

SpectrumPtr named_spectrum(std::string_view name, const Location& where) {
  for (const Named& n : kNamed)
    if (n.name == name) return n.get();
  const auto names = spectrum_names();
  if (is_known_to_pbrt(name))
    fail(where, "pbrt-v4's spectrum \"{}\" is not available; what there is: {}, or a .spd file", name,
         fmt::join(names, ", "));
  fail(where, "unknown spectrum \"{}\"{}", name, suggestion(name, names));
}

}  // namespace frond
