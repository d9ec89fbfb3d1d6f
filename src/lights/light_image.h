#pragma once

#include <vector>

#include "core/image.h"
#include "core/params.h"
#include "spectra/color/color_space.h"
#include "spectra/color/rgb_upsampling.h"

namespace frond {

/// A light's image: linear R, G and B, not negative.
struct ColorImage {
  Image image;
  const ColorSpace* space;  ///< of the file; sRGB if the file states none
};

/// Returns the luminance of each pixel, row by row.
std::vector<float> luminances_of(const ColorImage&);

/// Reads the image of parameter "filename". Values below 0 are set to 0 with a warning.
ColorImage read_light_image(const Params& p);

/// An emissive image. Each colour is converted at load time to a multiple of a smooth reflectance times D65 of
/// luminance 1. Rows run down; v = 0 is the top.
class LightImage {
 public:
  explicit LightImage(const ColorImage&);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Luminances of the texels, row by row.
  const std::vector<float>& luminances() const { return luminances_; }
  double mean_luminance() const;
  /// Spectrum emitted by white texels.
  const SpectrumPtr& white() const { return white_; }

  /// Returns the emission of the texel at (u, v), clamped to the image.
  SampledSpectrum nearest(Vec2 uv, const SampledWavelengths& lambda) const;
  /// Returns the emission interpolated between texel centres, clamped to the image.
  SampledSpectrum bilinear(Vec2 uv, const SampledWavelengths& lambda) const;

 private:
  struct Color {
    SigmoidPolynomial reflectance;
    float scale;
  };

  size_t texel(int x, int y) const;
  /// Returns the texel's emission relative to white.
  SampledSpectrum texel_spectrum(size_t texel, const SampledWavelengths& lambda) const;

  int width_, height_;
  std::vector<uint32_t> texels_;  ///< indices in colors_
  std::vector<Color> colors_;
  std::vector<float> luminances_;
  SpectrumPtr white_;
};

}  // namespace frond
