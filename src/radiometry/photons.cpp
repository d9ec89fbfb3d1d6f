#include "radiometry/photons.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "radiometry/lit_bands.h"
#include "spectra/wavelengths/spectrum_points.h"

namespace frond {
namespace {

/// Returns the bands in and next to the interval, in ascending order of wavelength.
std::vector<size_t> bands_of_par(std::span<const Band> bands) {
  constexpr double kSlack = 10;
  std::vector<size_t> within;
  for (size_t i = 0; i < bands.size(); ++i)
    if (bands[i].response.empty() && bands[i].nm >= kPar_nm.min - kSlack && bands[i].nm <= kPar_nm.max + kSlack)
      within.push_back(i);
  std::ranges::sort(within, {}, [bands](size_t i) { return bands[i].nm; });
  return within;
}

}  // namespace

bool PhotonWeights::cover_par(std::span<const Band> bands) {
  constexpr double kSlack = 10, kWidest = 50;
  const std::vector<size_t> within = bands_of_par(bands);
  if (within.size() < 2) return false;
  if (bands[within.front()].nm > kPar_nm.min + kSlack || bands[within.back()].nm < kPar_nm.max - kSlack) return false;
  for (size_t k = 1; k < within.size(); ++k)
    if (bands[within[k]].nm - bands[within[k - 1]].nm > kWidest) return false;
  return true;
}

std::optional<PhotonWeights> PhotonWeights::from_irradiance(std::span<const Band> bands, const Spectrum& irradiance) {
  if (!cover_par(bands)) return {};
  check_covers(irradiance, kPar_nm, "photons need");
  const std::vector<size_t> within = bands_of_par(bands);
  std::vector<double> nm = points_nm(irradiance, kPar_nm);
  for (const size_t i : within)
    if (kPar_nm.contains(bands[i].nm)) nm.push_back(bands[i].nm);
  std::ranges::sort(nm);
  const auto photons = [&irradiance](double at) { return double(irradiance.at(float(at))) * at / kPhotonEnergy; };
  PhotonWeights result{std::vector<double>(bands.size())};
  size_t above = 0;  // first of `within` at or above the cell; the cell lies between it and the one before
  for (size_t i = 1; i < nm.size(); ++i) {
    const double a = nm[i - 1], b = nm[i], middle = (a + b) / 2;
    while (above < within.size() && bands[within[above]].nm < middle) ++above;
    const size_t high = std::min(above, within.size() - 1), low = above == 0 ? 0 : above - 1;
    const double x = bands[within[low]].nm, width = bands[within[high]].nm - x;
    const auto share_of_high = [&](double at) { return low == high ? 0 : (at - x) / width; };
    // Simpson's rule, exact for products of up to three linear functions.
    for (const auto& [at, weight] : {std::pair{a, 1.0}, {middle, 4.0}, {b, 1.0}}) {
      const double sum = photons(at) * weight * (b - a) / 6;
      result.weights[within[high]] += sum * share_of_high(at);
      result.weights[within[low]] += sum * (1 - share_of_high(at));
      result.incident += sum;
    }
  }
  if (!(result.incident > 0)) fail({}, "the irradiance is 0 from 400 to 700 nm: there are no photons to count");
  for (double& w : result.weights) w /= result.incident;
  return result;
}

MeanError PhotonWeights::share(std::span<const MeanError> by_band) const {
  MeanError sum;
  for (size_t band = 0; band < by_band.size(); ++band) {
    if (weights[band] == 0) continue;  // an error may be unknown there
    sum.mean += weights[band] * by_band[band].mean;
    sum.standard_error += weights[band] * by_band[band].standard_error;
  }
  return sum;
}

}  // namespace frond
