#pragma once

#include <vector>

#include "core/spectrum.h"
#include "spectra/color/rgb_upsampling.h"

namespace frond {

/// Table of smooth reflectances of all colours of an RGB space, for textures: coefficients are interpolated between
/// fits on a grid (Jakob and Hanika 2019). For sRGB the error of XYZ (white: Y = 1) is 7e-4 on average and 2e-2 at
/// most, for the purest and brightest colours. Greys are flat. Thread-safe.
class ReflectanceTable {
 public:
  /// Returns the table of sRGB. The first call computes it, in some tens of milliseconds.
  static const ReflectanceTable& srgb();

  explicit ReflectanceTable(const ColorSpace& space);
  /// Returns the reflectance of a colour (r, g, b, unused), each in [0, 1].
  SigmoidPolynomial at(Float4 rgb) const;
  /// Returns the same at the wavelengths of a path; 0 in unused lanes.
  SampledSpectrum sample(Float4 rgb, const SampledWavelengths& lambda) const;

 private:
  /// Reflectance of a colour whose largest and smallest channel sum to at most 1.
  SigmoidPolynomial dark(Float4 rgb) const;
  /// Nodes on each axis: the largest channel, and the ratios of the other two to it.
  static constexpr int kNodes = 20;
  Float4& node(int channel, int z, int y, int x) {
    return nodes_[size_t(((channel * kNodes + z) * kNodes + y) * kNodes + x)];
  }

  Float4 luminance_{};  ///< luminance of r, g and b
  /// Differences between the coefficients and the coefficients of the flat reflectance of the colour's luminance Y,
  /// times sqrt(Y (1 - Y)). Unlike the coefficients, they are smooth and bounded at black and white.
  std::vector<Float4> nodes_;
};

}  // namespace frond
