#include "instruments/errors/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "instruments/errors/separable_filter.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

// Names and numbers are the paper's: section 4.1 for colour, 4.2 for features, 4.3 for both.
constexpr double kQc = 0.7, kPc = 0.4, kPt = 0.95;  // colour: exponent, and the knee of its range
constexpr double kQf = 0.5, kFeatureWidth_deg = 0.082;

/// Three images of one channel each.
using Planes = std::array<Image, 3>;

double cube_root_or_line(double t) {
  constexpr double kDelta = 6.0 / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

/// Everything colorimetric is relative to the display's white.
class Colorimetry {
 public:
  Triple white_relative_xyz(const Triple& rgb) const {
    const Triple xyz = space_.xyz_from_rgb * rgb;
    return {xyz[0] / white_[0], xyz[1] / white_[1], xyz[2] / white_[2]};
  }
  /// Linear opponent colour space in which contrast sensitivity is filtered.
  Triple ycxcz(const Triple& rgb) const {
    const auto [x, y, z] = white_relative_xyz(rgb);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
  }
  Triple rgb_of_ycxcz(const Triple& c) const {
    const double y = (c[0] + 16) / 116, x = y + c[1] / 500, z = y - c[2] / 200;
    return space_.rgb_from_xyz * Triple{x * white_[0], y * white_[1], z * white_[2]};
  }
  /// L*a*b* with chroma reduced in dark colours (Hunt effect).
  Triple hunt_lab(const Triple& rgb) const {
    const Triple r = white_relative_xyz(rgb);
    const double fx = cube_root_or_line(r[0]), fy = cube_root_or_line(r[1]), fz = cube_root_or_line(r[2]);
    const double lightness = 116 * fy - 16;
    return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
  }

 private:
  const ColorSpace& space_ = color_space("srgb", {});
  Triple white_ = space_.xyz_from_rgb * Triple{1, 1, 1};
};

/// HyAB distance: city-block in lightness, Euclidean in chroma (Abasi et al. 2020).
double hyab(const Triple& a, const Triple& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

/// Sum of two Gaussians in space whose Fourier transform is the contrast sensitivity of one channel: a sqrt(pi/b)
/// exp(-pi^2 x^2 / b), x in degrees. Each is separable, their sum is not.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

int sensitivity_radius(double pixels_per_degree) {
  constexpr double kWidest = 0.04;
  return static_cast<int>(
      std::ceil(3 * std::sqrt(kWidest / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
}

std::vector<double> gaussian(double b, double pixels_per_degree) {
  const int radius = sensitivity_radius(pixels_per_degree);
  std::vector<double> g;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / pixels_per_degree;
    g.push_back(std::exp(-std::numbers::pi * std::numbers::pi * x * x / b));
  }
  return g;
}

double sum_of(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum;
}

Image perceived(const Image& channel, const Sensitivity& s, double pixels_per_degree) {
  const auto g1 = gaussian(s.b1, pixels_per_degree), g2 = gaussian(s.b2, pixels_per_degree);
  // In two dimensions the kernel's total is the square of that along a line, and so is the factor sqrt(pi / b).
  double w1 = s.a1 * std::numbers::pi / s.b1, w2 = s.a2 * std::numbers::pi / s.b2;
  const double total = w1 * sum_of(g1) * sum_of(g1) + w2 * sum_of(g2) * sum_of(g2);
  w1 /= total, w2 /= total;
  Image result = separable_filter(channel, g1, g1);
  const Image second = s.a2 > 0 ? separable_filter(channel, g2, g2) : Image();
  for (size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = static_cast<float>(w1 * static_cast<double>(result.pixels[i]) +
                                          (s.a2 > 0 ? w2 * static_cast<double>(second.pixels[i]) : 0));
  return result;
}

Planes opponent_planes(const Image& image, const Colorimetry& colors) {
  assert(image.channels.size() == 3);
  Planes planes{Image(image.width, image.height, {"Y"}), Image(image.width, image.height, {"Cx"}),
                Image(image.width, image.height, {"Cz"})};
  for (size_t i = 0; i < planes[0].pixels.size(); ++i) {
    const auto shown = [&](size_t c) { return std::clamp(static_cast<double>(image.pixels[3 * i + c]), 0.0, 1.0); };
    const Triple opponent = colors.ycxcz({shown(0), shown(1), shown(2)});
    for (size_t c = 0; c < 3; ++c) planes[c].pixels[i] = static_cast<float>(opponent[c]);
  }
  return planes;
}

/// Maps [0, max] to [0, 1] piecewise linearly: differences up to kPc of the largest use kPt of the range.
double remap_difference(double difference, double largest) {
  const double knee = kPc * largest;
  if (difference < knee) return kPt / knee * difference;
  return kPt + (difference - knee) / (largest - knee) * (1 - kPt);
}

std::vector<Triple> filtered_lab(const Planes& opponent, const Colorimetry& colors, double pixels_per_degree) {
  Planes seen;
  for (size_t c = 0; c < 3; ++c) seen[c] = perceived(opponent[c], kSensitivities[c], pixels_per_degree);
  std::vector<Triple> lab(seen[0].pixels.size());
  for (size_t i = 0; i < lab.size(); ++i) {
    Triple rgb = colors.rgb_of_ycxcz({static_cast<double>(seen[0].pixels[i]), static_cast<double>(seen[1].pixels[i]),
                                      static_cast<double>(seen[2].pixels[i])});
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
    lab[i] = colors.hunt_lab(rgb);
  }
  return lab;
}

/// First (edges) or second (points) derivative of a Gaussian along a line, normalised such that the positive and the
/// negative weights of the two-dimensional kernel sum to 1 and -1.
struct FeatureKernel {
  std::vector<double> derivative, gaussian;
};

FeatureKernel feature_kernel(bool points, double pixels_per_degree) {
  const double sigma = 0.5 * kFeatureWidth_deg * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  FeatureKernel k;
  double positive = 0, negative = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-i * i / (2 * sigma * sigma));
    const double d = (points ? i * i / (sigma * sigma) - 1 : -i) * g;
    k.gaussian.push_back(g);
    k.derivative.push_back(d);
    (d > 0 ? positive : negative) += std::abs(d);
  }
  const double across = sum_of(k.gaussian);
  for (double& g : k.gaussian) g /= across;
  for (double& d : k.derivative) d /= d > 0 ? positive : negative;
  return k;
}

/// Magnitude of edges or points, independent of their orientation.
std::vector<double> feature_strength(const Image& lightness, const FeatureKernel& k) {
  const Image x = separable_filter(lightness, k.derivative, k.gaussian);
  const Image y = separable_filter(lightness, k.gaussian, k.derivative);
  std::vector<double> strength(x.pixels.size());
  for (size_t i = 0; i < strength.size(); ++i)
    strength[i] = std::hypot(static_cast<double>(x.pixels[i]), static_cast<double>(y.pixels[i]));
  return strength;
}

std::vector<double> feature_difference(Image reference, Image test, double pixels_per_degree) {
  for (Image* p : {&reference, &test})
    for (float& v : p->pixels) v = (v + 16) / 116;
  std::vector<double> largest(reference.pixels.size());
  for (const bool points : {false, true}) {
    const FeatureKernel k = feature_kernel(points, pixels_per_degree);
    const auto a = feature_strength(reference, k), b = feature_strength(test, k);
    for (size_t i = 0; i < largest.size(); ++i) largest[i] = std::max(largest[i], std::abs(a[i] - b[i]));
  }
  for (double& d : largest) d = std::pow(d / std::numbers::sqrt2, kQf);
  return largest;
}

}  // namespace

std::vector<float> flip_map(const Image& reference, const Image& test, double pixels_per_degree) {
  assert(reference.width == test.width && reference.height == test.height);
  const Colorimetry colors;
  const Planes a = opponent_planes(reference, colors), b = opponent_planes(test, colors);
  const auto lab_a = filtered_lab(a, colors, pixels_per_degree), lab_b = filtered_lab(b, colors, pixels_per_degree);
  const auto features = feature_difference(a[0], b[0], pixels_per_degree);
  const double largest = std::pow(hyab(colors.hunt_lab({0, 1, 0}), colors.hunt_lab({0, 0, 1})), kQc);
  std::vector<float> map(features.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const double color = remap_difference(std::pow(hyab(lab_a[i], lab_b[i]), kQc), largest);
    map[i] = static_cast<float>(std::pow(color, 1 - features[i]));
  }
  return map;
}

double mean_flip(const Image& reference, const Image& test, double pixels_per_degree) {
  const auto map = flip_map(reference, test, pixels_per_degree);
  double sum = 0;
  for (const float v : map) sum += static_cast<double>(v);
  return map.empty() ? 0 : sum / static_cast<double>(map.size());
}

}  // namespace frond
