#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/plugin.h"
#include "core/random.h"
#include "core/vec.h"

namespace frond {

/// Some samples of one pixel, one after the other.
struct PixelSamples {
  int x, y;
  uint64_t first;
  uint32_t count = 1;
};

/// Numbers in [0, 1) for the dimensions of a pixel's samples. A number depends on seed, pixel, 64-bit sample index and
/// dimension alone. Thread-safe.
class Sampler {
 public:
  virtual ~Sampler() = default;
  /// One number for each of the samples, into `u`.
  virtual void get1d(const PixelSamples& samples, uint32_t dimension, float* u) const = 0;
  /// The same of a pair, which is one dimension of its own.
  virtual void get2d(const PixelSamples& samples, uint32_t dimension, Vec2* u) const = 0;
  /// Samples per pixel that the scene asks for.
  virtual int samples_per_pixel() const = 0;
  virtual uint64_t seed() const = 0;
};

/// The numbers of one sample, one dimension after the other.
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

struct SamplerInfo : PluginInfo {
  /// `seed` goes before the sampler's own parameter.
  std::unique_ptr<Sampler> (*make)(const Params&, std::optional<uint64_t> seed);
};

/// Key of one sample of one pixel: the root of its random streams.
constexpr uint64_t sample_key(uint64_t seed, int x, int y, uint64_t sample_index) {
  return hash_key(seed, (uint64_t(uint32_t(x)) << 32) | uint32_t(y), sample_index);
}

}  // namespace frond
