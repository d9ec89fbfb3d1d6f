#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/plugin.h"

namespace frond {

/// Samples `first` to `first + count - 1` of the pixel (x, y).
struct PixelSamples {
  int x, y;
  uint64_t first;
  uint32_t count = 1;
};

/// Dimensions of a camera ray and of the first vertex of its path, which a sampler may distribute well together. The
/// numbers of later vertices follow from `count` on.
enum class Dimension : uint32_t { wavelengths, film, lens, time, light, on_light, lobe, direction, count };

/// Generator of sample values in [0, 1), as pbrt's Sampler. A value depends only on the seed, the pixel, the 64-bit
/// sample index and the dimension. Thread-safe.
class Sampler {
 public:
  virtual ~Sampler() = default;
  /// Writes one value for each of `samples` to `u`.
  virtual void get1d(const PixelSamples& samples, uint32_t dimension, float* u) const = 0;
  /// Writes one pair for each of `samples` to `u`. A pair takes one dimension; get1d must not use the same dimension.
  virtual void get2d(const PixelSamples& samples, uint32_t dimension, Vec2* u) const = 0;
  /// Number of samples per pixel that the scene file states.
  virtual int samples_per_pixel() const = 0;
  virtual uint64_t seed() const = 0;
};

/// Sample values of one sample of one pixel; each call uses the next dimension.
class SampleNumbers {
 public:
  SampleNumbers(const Sampler& sampler, int x, int y, uint64_t index, uint32_t first_dimension = 0)
      : sampler_(sampler), sample_{x, y, index}, dimension_(first_dimension) {}
  float get1d() {
    float u;
    sampler_.get1d(sample_, dimension_++, &u);
    return u;
  }
  Vec2 get2d() {
    Vec2 u;
    sampler_.get2d(sample_, dimension_++, &u);
    return u;
  }

 private:
  const Sampler& sampler_;
  PixelSamples sample_;
  uint32_t dimension_;
};

/// Plug-in record of a sampler.
struct SamplerInfo : PluginInfo {
  /// Returns a sampler, not null. `seed`, if given, overrides the seed of the sampler's parameters.
  std::unique_ptr<Sampler> (*make)(const Params&, std::optional<uint64_t> seed);
};

/// Key of one sample of one pixel, from which the keys of its random streams are derived.
constexpr uint64_t sample_key(uint64_t seed, int x, int y, uint64_t sample_index) {
  return hash_key(seed, (uint64_t(uint32_t(x)) << 32) | uint32_t(y), sample_index);
}

}  // namespace frond
