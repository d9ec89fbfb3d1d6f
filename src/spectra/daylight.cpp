#include "spectra/daylight.h"

#include <algorithm>
#include <cmath>

#include "spectra/analytic.h"
#include "spectra/named_tables.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

/// Revision of Planck's second radiation constant c2 since the CIE defined the daylight illuminants.
constexpr double kRevised = 1.4388 / 1.4380;

}  // namespace

SpectrumPtr cie_daylight(double kelvin, DaylightDigits digits) {
  // Chromaticity on the daylight locus, and the factors M1 and M2 of the components S1 and S2 (CIE 15:2004, 3.1).
  const double k = 1e3 / kelvin;
  const double x = kelvin <= 7000 ? ((-4.6070 * k + 2.9678) * k + 0.09911) * k + 0.244063
                                  : ((-2.0064 * k + 1.9018) * k + 0.24748) * k + 0.237040;
  const double y = (-3 * x + 2.870) * x - 0.275;
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const auto rounded = [digits](double share) {
    return digits == DaylightDigits::three ? std::round(1e3 * share) / 1e3 : share;
  };
  const double m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / m),
               m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  std::vector<SpectrumPoint> points = named_column("S0");
  const auto s1 = named_column("S1"), s2 = named_column("S2");
  for (size_t i = 0; i < points.size(); ++i)
    points[i].value = std::max(0.0, points[i].value + m1 * s1[i].value + m2 * s2[i].value);
  return make_tabulated(points);
}

double kelvin_by_scale_of_1931(double kelvin) { return kelvin * kRevised; }

SpectrumPtr daylight(double kelvin) {
  const double t = kelvin_by_scale_of_1931(kelvin);
  if (t < 4000) return std::make_shared<BlackbodySpectrum>(t);
  return cie_daylight(t, DaylightDigits::all);
}

}  // namespace frond
