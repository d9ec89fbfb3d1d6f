#pragma once

#include <cstdint>
#include <vector>

#include "core/float4.h"
#include "core/image.h"
#include "scene/textures/texture_mapping.h"

namespace frond {

/// From an image file's values to linear ones.
struct ColorEncoding {
  enum class Curve : uint8_t { linear, srgb, power };
  Curve curve = Curve::linear;
  float gamma = 1;  ///< of `power`
  float decode(float v) const;
};

/// An image, its half, quarter and so on, of one channel or three: what a texture looks up over a footprint. Texels are
/// the file's own, whatever its size.
class MipMap {
 public:
  enum class Filter : uint8_t { point, bilinear, trilinear, ewa };
  enum class Wrap : uint8_t { repeat, black, clamp, octahedral_sphere };
  struct Options {
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::repeat;
    float max_anisotropy = 8;
  };

  MipMap() = default;
  /// `eight_bit`: the values are whole 255ths, which are kept in a byte each.
  MipMap(const Image& image, const ColorEncoding& encoding, bool eight_bit, const Options& options);

  /// Linear values; v runs up, the image's rows run down.
  Float4 at(const TextureCoordinates& place) const;
  int channels() const { return channels_; }
  /// Calls use(values) for each texel of the image.
  template <class Use>
  void each(const Use& use) const {
    for (int y = 0; y < levels_[0].height; ++y)
      for (int x = 0; x < levels_[0].width; ++x) use(texel(levels_[0], x, y));
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<uint8_t> bytes;  ///< encoded; empty: `values`
    std::vector<float> values;
  };
  Level halved(const Level& level) const;
  Float4 value(const Level& level, size_t index) const;
  Float4 texel(const Level& level, int x, int y) const;
  Float4 bilinear(const Level& level, Vec2 st) const;
  Float4 filtered(const TextureCoordinates& place) const;
  Float4 ellipse(size_t level, Vec2 st, Vec2 p, Vec2 q) const;
  Float4 of_ellipse(const TextureCoordinates& place) const;

  Options options_;
  int channels_ = 1;
  std::vector<Level> levels_;
  std::vector<float> decoded_;  ///< of bytes
  float size_ = 1;              ///< the longer side, texels
};

}  // namespace frond
