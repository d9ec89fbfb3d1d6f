#include "spectra/cie.h"

#include "spectra/analytic.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

constexpr int kFirstRow_nm = 360, kRowStep_nm = 5;

/// Row of the table: colour matching functions and the spectrum of D65.
struct CieRow {
  double xbar, ybar, zbar, d65;
};

// From 360 nm in steps of 5 nm to 830 nm. Colour matching functions: CIE 1931 standard colorimetric observer, 2
// degrees; D65: CIE standard illuminant D65, both as tabulated in CIE 15:2004, Colorimetry, 3rd edition.
constexpr CieRow kCieTable[] = {
    {0.0001299, 3.917e-06, 0.0006061, 46.6383},
    {0.0002321, 6.965e-06, 0.001086, 49.3637},
    {0.0004149, 1.239e-05, 0.001946, 52.0891},
    {0.0007416, 2.202e-05, 0.003486, 51.0323},
    {0.001368, 3.9e-05, 0.006450001, 49.9755},
    {0.002236, 6.4e-05, 0.01054999, 52.3118},
    {0.004243, 0.00012, 0.02005001, 54.6482},
    {0.00765, 0.000217, 0.03621, 68.7015},
    {0.01431, 0.000396, 0.06785001, 82.7549},
    {0.02319, 0.00064, 0.1102, 87.1204},
    {0.04351, 0.00121, 0.2074, 91.486},
    {0.07763, 0.00218, 0.3713, 92.4589},
    {0.13438, 0.004, 0.6456, 93.4318},
    {0.21477, 0.0073, 1.0390501, 90.057},
    {0.2839, 0.0116, 1.3856, 86.6823},
    {0.3285, 0.01684, 1.62296, 95.7736},
    {0.34828, 0.023, 1.74706, 104.865},
    {0.34806, 0.0298, 1.7826, 110.936},
    {0.3362, 0.038, 1.77211, 117.008},
    {0.3187, 0.048, 1.7441, 117.41},
    {0.2908, 0.06, 1.6692, 117.812},
    {0.2511, 0.0739, 1.5281, 116.336},
    {0.19536, 0.09098, 1.28764, 114.861},
    {0.1421, 0.1126, 1.0419, 115.392},
    {0.09564, 0.13902, 0.8129501, 115.923},
    {0.05795001, 0.1693, 0.6162, 112.367},
    {0.03201, 0.20802, 0.46518, 108.811},
    {0.0147, 0.2586, 0.3533, 109.082},
    {0.0049, 0.323, 0.272, 109.354},
    {0.0024, 0.4073, 0.2123, 108.578},
    {0.0093, 0.503, 0.1582, 107.802},
    {0.0291, 0.6082, 0.1117, 106.296},
    {0.06327, 0.71, 0.07824999, 104.79},
    {0.1096, 0.7932, 0.05725001, 106.239},
    {0.1655, 0.862, 0.04216, 107.689},
    {0.2257499, 0.9148501, 0.02984, 106.047},
    {0.2904, 0.954, 0.0203, 104.405},
    {0.3597, 0.9803, 0.0134, 104.225},
    {0.4334499, 0.9949501, 0.008749999, 104.046},
    {0.5120501, 1, 0.005749999, 102.023},
    {0.5945, 0.995, 0.0039, 100},
    {0.6784, 0.9786, 0.002749999, 98.1671},
    {0.7621, 0.952, 0.0021, 96.3342},
    {0.8425, 0.9154, 0.0018, 96.0611},
    {0.9163, 0.87, 0.001650001, 95.788},
    {0.9786, 0.8163, 0.0014, 92.2368},
    {1.0263, 0.757, 0.0011, 88.6856},
    {1.0567, 0.6949, 0.001, 89.3459},
    {1.0622, 0.631, 0.0008, 90.0062},
    {1.0456, 0.5668, 0.0006, 89.8026},
    {1.0026, 0.503, 0.00034, 89.5991},
    {0.9384, 0.4412, 0.00024, 88.6489},
    {0.8544499, 0.381, 0.00019, 87.6987},
    {0.7514, 0.321, 0.0001, 85.4936},
    {0.6424, 0.265, 4.999999e-05, 83.2886},
    {0.5419, 0.217, 3e-05, 83.4939},
    {0.4479, 0.175, 2e-05, 83.6992},
    {0.3608, 0.1382, 1e-05, 81.863},
    {0.2835, 0.107, 0, 80.0268},
    {0.2187, 0.0816, 0, 80.1207},
    {0.1649, 0.061, 0, 80.2146},
    {0.1212, 0.04458, 0, 81.2462},
    {0.0874, 0.032, 0, 82.2778},
    {0.0636, 0.0232, 0, 80.281},
    {0.04677, 0.017, 0, 78.2842},
    {0.0329, 0.01192, 0, 74.0027},
    {0.0227, 0.00821, 0, 69.7213},
    {0.01584, 0.005723, 0, 70.6652},
    {0.01135916, 0.004102, 0, 71.6091},
    {0.008110916, 0.002929, 0, 72.979},
    {0.005790346, 0.002091, 0, 74.349},
    {0.004109457, 0.001484, 0, 67.9765},
    {0.002899327, 0.001047, 0, 61.604},
    {0.00204919, 0.00074, 0, 65.7448},
    {0.001439971, 0.00052, 0, 69.8856},
    {0.0009999493, 0.0003611, 0, 72.4863},
    {0.0006900786, 0.0002492, 0, 75.087},
    {0.0004760213, 0.0001719, 0, 69.3398},
    {0.0003323011, 0.00012, 0, 63.5927},
    {0.0002348261, 8.48e-05, 0, 55.0054},
    {0.0001661505, 6e-05, 0, 46.4182},
    {0.000117413, 4.24e-05, 0, 56.6118},
    {8.307527e-05, 3e-05, 0, 66.8054},
    {5.870652e-05, 2.12e-05, 0, 65.0941},
    {4.150994e-05, 1.499e-05, 0, 63.3828},
    {2.935326e-05, 1.06e-05, 0, 63.8434},
    {2.067383e-05, 7.4657e-06, 0, 64.304},
    {1.455977e-05, 5.2578e-06, 0, 61.8779},
    {1.025398e-05, 3.7029e-06, 0, 59.4519},
    {7.221456e-06, 2.6078e-06, 0, 55.7054},
    {5.085868e-06, 1.8366e-06, 0, 51.959},
    {3.581652e-06, 1.2934e-06, 0, 54.6998},
    {2.522525e-06, 9.1093e-07, 0, 57.4406},
    {1.776509e-06, 6.4153e-07, 0, 58.8765},
    {1.251141e-06, 4.5181e-07, 0, 60.3125},
};
static_assert(std::size(kCieTable) == 95);

SpectrumPtr make_d65() {
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < std::size(kCieTable); ++i)
    points.push_back({double(kFirstRow_nm + kRowStep_nm * static_cast<int>(i)), kCieTable[i].d65});
  return make_tabulated(points);
}

}  // namespace

Triple cie_xyz(double lambda_nm) {
  if (!kCieRange_nm.contains(lambda_nm)) return {};
  const double x = (lambda_nm - kFirstRow_nm) / kRowStep_nm;
  const size_t i = std::min(static_cast<size_t>(x), std::size(kCieTable) - 2);
  const double t = x - static_cast<double>(i);
  const CieRow &a = kCieTable[i], &b = kCieTable[i + 1];
  return {a.xbar + t * (b.xbar - a.xbar), a.ybar + t * (b.ybar - a.ybar), a.zbar + t * (b.zbar - a.zbar)};
}

Triple to_xyz(const Spectrum& s) {
  // Gauss-Legendre quadrature with two points in each nanometre is exact for the product of two functions that are
  // linear between whole nanometres.
  const double offset = 0.5 / std::sqrt(3.0);
  Triple sum{};
  for (int nm = int(kCieRange_nm.min); nm < int(kCieRange_nm.max); ++nm)
    for (const double side : {-offset, offset}) {
      const double lambda_nm = nm + 0.5 + side;
      const double value = double(s.at(static_cast<float>(lambda_nm))) / 2;
      const Triple bar = cie_xyz(lambda_nm);
      for (size_t i = 0; i < 3; ++i) sum[i] += bar[i] * value;
    }
  return sum;
}

double photometric(const Spectrum& s) { return to_xyz(s)[1]; }

SpectrumPtr unit_luminance(SpectrumPtr s) {
  const double y = photometric(*s);
  return y > 0 ? std::make_shared<ScaledSpectrum>(std::move(s), 1 / y) : s;
}

SpectrumPtr d65() {
  static const SpectrumPtr spectrum = make_d65();
  return spectrum;
}

SpectrumPtr unit_d65() {
  static const SpectrumPtr spectrum = std::make_shared<DenseSpectrum>(
      sample_densely(*unit_luminance(d65()), int(kCieRange_nm.min), int(kCieRange_nm.max)));
  return spectrum;
}

}  // namespace frond
