#include "leaf/fluorescence/emission.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/fluorescence.h"

namespace frond::leaf {
namespace {

constexpr auto kCount = static_cast<size_t>(kEmission_nm.max - kEmission_nm.min) + 1;

double nm_at(size_t i) { return kEmission_nm.min + static_cast<double>(i); }

/// A Gaussian of height 1 by its full width at half maximum.
double gaussian(double nm, double center_nm, double full_width_nm) {
  const double x = (nm - center_nm) / full_width_nm;
  return std::exp(-4 * std::numbers::ln2 * x * x);
}

}  // namespace

// Peaks, full widths at half maximum and ratio of heights: P. J. Zarco-Tejada, J. R. Miller, G. H. Mohammed, T. L.
// Noland, P. H. Sampson 2002, "Vegetation stress detection through chlorophyll a + b estimation and fluorescence
// effects on hyperspectral imagery", Journal of Environmental Quality 31:1433-1441, figure 2: a simulated leaf of 50
// ug/cm2.
EmissionShape::EmissionShape() : name_("Gaussians at 688 and 746 nm (Zarco-Tejada et al. 2002)"), density_(kCount) {
  constexpr double kFarRedHeight = 0.94;
  for (size_t i = 0; i < kCount; ++i)
    density_[i] = gaussian(nm_at(i), 688, 30) + kFarRedHeight * gaussian(nm_at(i), 746, 52);
  normalize();
}

EmissionShape::EmissionShape(std::string name, std::span<const SpectrumPoint> points, const Location& where)
    : name_(std::move(name)), density_(kCount) {
  const TabulatedSpectrum spectrum(points);
  const Interval known = spectrum.range_nm();
  for (size_t i = 0; i < kCount; ++i)
    if (known.contains(nm_at(i))) density_[i] = double(spectrum.at(static_cast<float>(nm_at(i))));
  if (!(std::ranges::max(density_) > 0))
    fail(where, "{}: the emission is 0 from {} to {} nm: give wavelengths in nm and densities of photons", name_,
         kEmission_nm.min, kEmission_nm.max);
  normalize();
}

void EmissionShape::normalize() {
  const double sum = std::accumulate(density_.begin(), density_.end(), 0.0);
  for (double& d : density_) d /= sum;
}

double EmissionShape::at(double lambda_nm) const {
  if (!kEmission_nm.contains(lambda_nm)) return 0;
  const double x = lambda_nm - kEmission_nm.min;
  const size_t i = std::min(static_cast<size_t>(x), kCount - 2);
  return std::lerp(density_[i], density_[i + 1], x - static_cast<double>(i));
}

double stokes_gate(double emission_nm, double excitation_nm) {
  constexpr double kWidth_nm = 10;
  return 1 / (1 + std::exp((excitation_nm - emission_nm) / kWidth_nm));
}

}  // namespace frond::leaf
