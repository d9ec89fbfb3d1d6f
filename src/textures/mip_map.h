#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/math/float4.h"
#include "textures/texture_mapping.h"

namespace frond {

/// Conversion of an image file's values to linear values.
struct ColorEncoding {
  /// As parameter "encoding" of pbrt-v4: identity, the sRGB transfer function, or a power law.
  enum class Curve : uint8_t { linear, srgb, power };
  Curve curve = Curve::linear;
  float gamma = 1;  ///< exponent of `power`
  /// Returns the linear value of an encoded one, both nominally 0 to 1.
  float decode(float v) const;
};

/// MIP map of an image with one or three channels, for lookups over a footprint. The finest level is the image itself,
/// of any size.
class MipMap {
 public:
  /// Reconstruction between texels and levels: pbrt 4th ed., 10.4.3; ewa: the elliptically weighted average.
  enum class Filter : uint8_t { point, bilinear, trilinear, ewa };
  /// Values beyond the edges; octahedral_sphere continues across an edge as the equal-area map of a sphere does.
  enum class Wrap : uint8_t { repeat, black, clamp, octahedral_sphere };
  struct Options {
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::repeat;
    float max_anisotropy = 8;  ///< largest ratio of the ellipse's axes, at least 1
  };

  MipMap() = default;
  /// `eight_bit`: the values are multiples of 1/255, which are stored as bytes.
  MipMap(const Image& image, const ColorEncoding& encoding, bool eight_bit, const Options& options);

  /// Returns filtered linear values. v increases upward; the image's rows run down.
  Float4 at(const TextureCoordinates& place) const;
  /// 1 or 3.
  int channels() const { return channels_; }
  /// Calls use(values) for each texel of the finest level.
  template <class Use>
  void for_each_texel(const Use& use) const {
    for (int y = 0; y < levels_[0].height; ++y)
      for (int x = 0; x < levels_[0].width; ++x) use(texel(levels_[0], x, y));
  }

 private:
  /// Image of one level, row by row from the top, channels interleaved.
  struct Level {
    int width = 0, height = 0;
    std::vector<uint8_t> bytes;  ///< encoded; empty: `values` is used
    std::vector<float> values;
  };
  Level halved(const Level& from) const;
  Float4 value(const Level& level, size_t index) const;
  Float4 texel(const Level& level, int x, int y) const;
  Float4 bilinear(const Level& level, Vec2 st) const;
  Float4 filtered(const TextureCoordinates& place) const;
  Float4 ellipse(size_t index, Vec2 st, Vec2 p, Vec2 q) const;
  Float4 filter_ellipse(const TextureCoordinates& place) const;

  Options options_;
  int channels_ = 1;
  std::vector<Level> levels_;
  std::vector<float> decoded_;  ///< linear value of each byte
  float size_ = 1;              ///< longer side in texels
};

}  // namespace frond
