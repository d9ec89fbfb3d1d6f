#include "lights/sky_shape.h"

#include <algorithm>
#include <numbers>

#include "spectra/spectrl2.h"

namespace frond {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

/// Row of table 1 of Perez et al. 1993: the parameters of skies whose clearness is at least `clearness`.
struct PerezBin {
  double clearness;
  double x[5][4];  ///< a to e; each x1 + x2 Z + brightness (x3 + x4 Z), with the sun's zenith angle Z
};

constexpr PerezBin kPerez[] = {
    {1,
     {{1.3525, -0.2576, -0.269, -1.4366},
      {-0.767, 0.0007, 1.2734, -0.1233},
      {2.8, 0.6004, 1.2375, 1},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {1.065,
     {{-1.2219, -0.773, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.975, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.108},
      {0.2624, 0.0672, -0.219, -0.4285}}},
    {1.23,
     {{-1.1, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5, 1.1766},
      {24.7219, -13.0812, -37.7, 34.8438},
      {-5, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {1.5,
     {{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3, -62.25, 52.0781},
      {-3.5, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {1.95,
     {{-0.6, -0.3566, -2.5, 2.325},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21, -4.7656, -21.5906, 7.2492},
      {-3.5, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {2.8,
     {{-1.0156, -0.367, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.85, 3.375},
      {14, -0.9999, -7.1406, 7.5469},
      {-3.4, -0.1078, -1.075, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {4.5,
     {{-1, 0.0211, 0.5025, -0.5119},
      {-0.3, 0.1922, 0.7023, -1.6317},
      {19, -5, 1.2438, -1.9094},
      {-4, 0.025, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {6.2,
     {{-1.05, 0.0289, 0.426, 0.359},
      {-0.325, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5, -46.1148, 55.375},
      {-7.2312, 0.405, 13.35, 0.6234},
      {1.5, -0.6426, 1.8564, 0.5636}}},
};

/// Parameters a, b, c, d, e of the CIE's 15 skies.
constexpr double kCie[kCieSkies][5] = {
    {4, -0.7, 0, -1, 0},          // 1: overcast, steep gradation, azimuthally uniform
    {4, -0.7, 2, -1.5, 0.15},     // 2: overcast, steep gradation, slightly brighter toward the sun
    {1.1, -0.8, 0, -1, 0},        // 3: overcast, moderate gradation, azimuthally uniform
    {1.1, -0.8, 2, -1.5, 0.15},   // 4: overcast, moderate gradation, slightly brighter toward the sun
    {0, -1, 0, -1, 0},            // 5: uniform
    {0, -1, 2, -1.5, 0.15},       // 6: partly cloudy, no gradation, slightly brighter toward the sun
    {0, -1, 5, -2.5, 0.3},        // 7: partly cloudy, no gradation, brighter circumsolar region
    {0, -1, 10, -3, 0.45},        // 8: partly cloudy, no gradation, distinct corona
    {-1, -0.55, 2, -1.5, 0.15},   // 9: partly cloudy, sun obscured
    {-1, -0.55, 5, -2.5, 0.3},    // 10: partly cloudy, brighter circumsolar region
    {-1, -0.55, 10, -3, 0.45},    // 11: white-blue sky, distinct corona
    {-1, -0.32, 10, -3, 0.45},    // 12: clear, low turbidity
    {-1, -0.32, 16, -3, 0.3},     // 13: clear, polluted
    {-1, -0.15, 16, -3, 0.3},     // 14: cloudless turbid, broad corona
    {-1, -0.15, 24, -2.8, 0.15},  // 15: white-blue turbid, broad corona
};

}  // namespace

SkyTables::SkyTables(const SkyShape& shape) {
  for (size_t i = 0; i <= kCells; ++i) {
    const float x = float(i) / kCells;
    gradation_[i] = shape.gradation(x);
    indicatrix_[i] = shape.indicatrix(2 * std::asin(x));
  }
}

SkyShape perez_sky(double sun_zenith_deg, double direct_normal, double diffuse) {
  constexpr double kSolarConstant = 1361;                                               // W/m^2
  constexpr double kLeastBrightness = 0.2, kFromClearness = 1.065, kToClearness = 2.8;  // see the header
  const double zenith = sun_zenith_deg * std::numbers::pi / 180, cubed = 1.041 * zenith * zenith * zenith;
  const double clearness = ((diffuse + direct_normal) / diffuse + cubed) / (1 + cubed);
  double brightness = relative_air_mass(sun_zenith_deg) * diffuse / kSolarConstant;
  if (clearness > kFromClearness && clearness < kToClearness) brightness = std::max(brightness, kLeastBrightness);
  size_t bin = 0;
  while (bin + 1 < std::size(kPerez) && clearness >= kPerez[bin + 1].clearness) ++bin;
  double p[5];
  for (size_t i = 0; i < 5; ++i) {
    const double* x = kPerez[bin].x[i];
    p[i] = x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith);
  }
  if (bin == 0) {  // the overcast bin has its own c and d
    const double *c = kPerez[0].x[2], *d = kPerez[0].x[3];
    p[2] = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
    p[3] = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  }
  return {float(p[0]), float(std::min(p[1], 0.0)), float(p[2]), float(p[3]), float(p[4])};
}

SkyShape cie_sky(int type) {
  const double* p = kCie[type - 1];
  return {float(p[0]), float(p[1]), float(p[2]), float(p[3]), float(p[4]), float(std::exp(p[3] * kHalfPi))};
}

}  // namespace frond
