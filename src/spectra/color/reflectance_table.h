#pragma once

#include <vector>

#include "core/spectrum.h"
#include "spectra/color/rgb_upsampling.h"

namespace frond {

/// Smooth reflectances of all colours of sRGB, for what needs them by the million: interpolated between fits on a grid,
/// as Jakob and Hanika 2019 do. XYZ is off by 7e-4 on average (white: Y = 1), by 2e-2 at most: for the purest and
/// brightest colours. Greys are flat.
class ReflectanceTable {
 public:
  /// Made when first asked for: some tens of milliseconds.
  static const ReflectanceTable& srgb();

  explicit ReflectanceTable(const ColorSpace& space);
  /// Of a colour (r, g, b, anything) in [0, 1].
  SigmoidPolynomial at(Float4 rgb) const;
  /// The same at a path's wavelengths.
  SampledSpectrum sample(Float4 rgb, const SampledWavelengths& lambda) const;

 private:
  SigmoidPolynomial dark(Float4 rgb) const;
  /// Of the largest channel and of the other two's shares of it.
  static constexpr int kNodes = 20;
  Float4& node(int channel, int z, int y, int x) {
    return nodes_[size_t(((channel * kNodes + z) * kNodes + y) * kNodes + x)];
  }

  Float4 luminance_{};  ///< of r, g and b
  /// Coefficients, less those of the flat reflectance of the colour's luminance Y, times sqrt(Y (1 - Y)): that is
  /// smooth, and bounded at black and white, where the coefficients are not.
  std::vector<Float4> nodes_;
};

}  // namespace frond
