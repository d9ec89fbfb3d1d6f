#include "spectra/color/reflectance_table.h"

#include <cstring>

#include "core/parallel.h"

namespace frond {
namespace {

/// Luminances are clamped to [kLeast, 1 - kLeast], so that sqrt(Y (1 - Y)) is not 0.
constexpr float kLeast = 1e-6f;

float clamped_luminance(Float4 weights, Float4 rgb) { return std::clamp(sum(weights * rgb), kLeast, 1 - kLeast); }

}  // namespace

const ReflectanceTable& ReflectanceTable::srgb() {
  static const ReflectanceTable table(*find_color_space("srgb"));
  return table;
}

ReflectanceTable::ReflectanceTable(const ColorSpace& space) : nodes_(size_t(3 * kNodes * kNodes * kNodes)) {
  const auto& y = space.xyz_from_rgb.row[1];
  luminance_ = Float4{float(y[0]), float(y[1]), float(y[2]), 0};
  constexpr double kStep = 1.0 / (kNodes - 1), kDarkest = 1e-3;
  const auto share = [](int node) { return node * kStep * node * kStep; };
  for (int channel = 0; channel < 3; ++channel)
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) {
        if (i == kNodes - 1 && j == kNodes - 1) continue;  // grey
        check_stop();
        // From bright to dark, each fit starts at the scaled result of the one before, which is close to its own.
        Float4 d{};
        bool is_first = true;
        for (int k = kNodes - 1; k >= 0; --k) {
          const double z = std::max(1 - share(kNodes - 1 - k), kDarkest);
          // Skip nodes of which all adjacent cells contain only colours that `at` computes by their complement.
          if (k > 0 && (1 - share(kNodes - k)) * (1 + share(std::max(std::min(i, j) - 1, 0))) > 1) continue;
          Triple rgb{};
          rgb[size_t(channel)] = z;
          rgb[size_t((channel + 1) % 3)] = share(i) * z;
          rgb[size_t((channel + 2) % 3)] = share(j) * z;
          const double luminance = std::clamp(y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2], 1e-6, 1 - 1e-6);
          const double scale = std::sqrt(luminance * (1 - luminance));
          Triple c{double(d[0]) / scale, double(d[1]) / scale, (double(d[2]) + luminance - 0.5) / scale};
          refine_reflectance(space, rgb, is_first, c);
          is_first = false;
          d = Float4{float(c[0] * scale), float(c[1] * scale), float(c[2] * scale - (luminance - 0.5)), 0};
          node(channel, k, j, i) = d;
        }
      }
}

namespace {

/// Cell of an axis and the position in it, from 0 to 1.
struct Cell {
  int index;
  float t;
};

/// Cell on an axis whose nodes are at (i / steps)^2: dense at 0.
Cell cell_of(float share, int nodes) {
  const int steps = nodes - 1, index = std::min(int(std::sqrt(share) * float(steps)), steps - 1);
  return {index, (share * float(steps * steps) - float(index * index)) / float(2 * index + 1)};
}
/// Cell on an axis whose nodes are at 1 - (i / steps)^2: dense at 1, for pure and bright colours.
Cell cell_of_size(float size, int nodes) {
  const Cell rest = cell_of(1 - size, nodes);
  return {nodes - 2 - rest.index, 1 - rest.t};
}

}  // namespace

SigmoidPolynomial ReflectanceTable::at(Float4 rgb) const {
  const float largest = std::max({rgb[0], rgb[1], rgb[2]}), smallest = std::min({rgb[0], rgb[1], rgb[2]});
  if (largest + smallest <= 1) return dark(rgb);
  // XYZ is linear in the reflectance: the complement of a reflectance has the complement of its colour.
  return dark(Float4{1 - rgb[0], 1 - rgb[1], 1 - rgb[2], 0}).complement();
}

SigmoidPolynomial ReflectanceTable::dark(Float4 rgb) const {
  const float r = rgb[0], g = rgb[1], b = rgb[2];
  int channel = 0;
  float z = r, x = g, y = b;
  if (g > r && g >= b)
    channel = 1, z = g, x = b, y = r;
  else if (b > r && b > g)
    channel = 2, z = b, x = r, y = g;
  const float luminance = clamped_luminance(luminance_, rgb);
  const float scale = 1 / std::sqrt(luminance * (1 - luminance));
  Float4 d{};
  if (z > 0) {
    const Cell cz = cell_of_size(std::min(z, 1.f), kNodes), cy = cell_of(std::min(y / z, 1.f), kNodes),
               cx = cell_of(std::min(x / z, 1.f), kNodes);
    const Float4* const corner =
        &nodes_[size_t(((channel * kNodes + cz.index) * kNodes + cy.index) * kNodes + cx.index)];
    const auto along_x = [&](const Float4* p) { return p[0] + cx.t * (p[1] - p[0]); };
    const auto along_y = [&](const Float4* p) {
      const Float4 near = along_x(p), far = along_x(p + kNodes);
      return near + cy.t * (far - near);
    };
    const Float4 near = along_y(corner), far = along_y(corner + ptrdiff_t(kNodes) * kNodes);
    d = near + cz.t * (far - near);
  }
  return SigmoidPolynomial::of(scale * d[0], scale * d[1], scale * (d[2] + luminance - 0.5f));
}

SampledSpectrum ReflectanceTable::sample(Float4 rgb, const SampledWavelengths& lambda) const {
  const Float4 used = Float4{0, 1, 2, 3} < float(lambda.count) ? Float4{1, 1, 1, 1} : Float4{};
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return SampledSpectrum(rgb[0] * used);
  Float4 nm;
  std::memcpy(&nm, lambda.nm.data(), sizeof nm);
  return SampledSpectrum(used * at(rgb).at(nm));
}

}  // namespace frond
