#include "radiometry/photons.h"

#include <algorithm>

namespace frond {

std::optional<PhotonWeights> PhotonWeights::of(std::span<const double> nm, const Spectrum& irradiance) {
  constexpr double kFirst = 400, kLast = 700, kSlack = 10, kWidest = 50;
  // Planck constant times speed of light times Avogadro constant, J m / mol (exact since 2019): W m^-2 nm^-1 at a
  // wavelength in nm become umol m^-2 s^-1 nm^-1 by lambda / kEnergy.
  constexpr double kEnergy = 6.62607015e-34 * 299792458 * 6.02214076e23 * 1e9 * 1e-6;
  PhotonWeights result{std::vector<double>(nm.size())};
  std::vector<size_t> within;
  for (size_t i = 0; i < nm.size(); ++i)
    if (nm[i] >= kFirst - kSlack && nm[i] <= kLast + kSlack) within.push_back(i);
  if (within.size() < 2 || nm[within.front()] > kFirst + kSlack || nm[within.back()] < kLast - kSlack) return {};
  for (size_t k = 1; k < within.size(); ++k)
    if (nm[within[k]] - nm[within[k - 1]] > kWidest) return {};
  for (size_t k = 0; k < within.size(); ++k) {
    // A band's weight covers the wavelengths between 400 and 700 nm that are nearest to it.
    const double here = nm[within[k]];
    const double below = k == 0 ? kFirst : std::max(kFirst, (nm[within[k - 1]] + here) / 2);
    const double above = k + 1 == within.size() ? kLast : std::min(kLast, (here + nm[within[k + 1]]) / 2);
    result.weights[within[k]] = std::max(0.0, above - below) * double(irradiance.at(float(here))) * here / kEnergy;
    result.incident += result.weights[within[k]];
  }
  if (!(result.incident > 0)) return {};
  for (double& w : result.weights) w /= result.incident;
  return result;
}

}  // namespace frond
