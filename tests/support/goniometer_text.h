#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace frond::test {

/// Angles (degrees) and wavelengths (nm) of a goniometer table.
struct GoniometerAngles {
  std::vector<double> incidences, wavelengths, thetas, phis;
};

/// Table of f(incidence, theta, phi, wavelength) at all combinations.
template <class F>
std::string goniometer_text(const GoniometerAngles& angles, const F& f) {
  std::string text = "# made\nincidence_deg,wavelength_nm,theta_deg,phi_deg,f_per_sr\n";
  for (const double incidence : angles.incidences)
    for (const double nm : angles.wavelengths)
      for (const double theta : angles.thetas)
        for (const double phi : angles.phis)
          text += fmt::format("{},{},{},{},{}\n", incidence, nm, theta, phi, f(incidence, theta, phi, nm));
  return text;
}

}  // namespace frond::test
