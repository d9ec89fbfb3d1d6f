#pragma once

#include <vector>

#include "core/image.h"
#include "core/params.h"
#include "spectra/color/color_space.h"
#include "spectra/color/rgb_upsampling.h"

namespace frond {

/// An image as a light's file has it: linear R, G and B, not negative.
struct ColorImage {
  Image image;
  const ColorSpace* space;  ///< the file's own; sRGB where it says none
};

/// Of its pixels, row by row.
std::vector<float> luminances_of(const ColorImage& image);

/// Of the parameter "filename". Values below 0 count as 0, with a warning.
ColorImage read_light_image(const Params& p);

/// An image whose texels give off light: each of its colours is a multiple of a smooth reflectance times D65 of
/// luminance 1, found once, at load. Rows run down; v = 0 is the top.
class LightImage {
 public:
  explicit LightImage(const ColorImage& image);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Of the texels, row by row.
  const std::vector<float>& luminances() const { return luminances_; }
  double mean_luminance() const;
  /// What white texels give off.
  const SpectrumPtr& white() const { return white_; }

  /// The texel that (u, v) lies in, or the nearest to it.
  SampledSpectrum nearest(Vec2 uv, const SampledWavelengths& lambda) const;
  /// Between the centres of texels; beyond them the edge goes on.
  SampledSpectrum bilinear(Vec2 uv, const SampledWavelengths& lambda) const;

 private:
  struct Color {
    SigmoidPolynomial reflectance;
    float scale;
  };

  size_t texel(int x, int y) const;
  /// Relative to the white.
  SampledSpectrum share(size_t texel, const SampledWavelengths& lambda) const;

  int width_, height_;
  std::vector<uint32_t> texels_;  ///< places in the colours
  std::vector<Color> colors_;
  std::vector<float> luminances_;
  SpectrumPtr white_;
};

}  // namespace frond
