#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/plugin.h"
#include "core/random.h"
#include "core/vec.h"

namespace frond {

/// Numbers in [0, 1) for the dimensions of one sample of one pixel, in the order asked for. What comes out depends on
/// seed, pixel, 64-bit sample index and the order of calls alone.
class Sampler {
 public:
  virtual ~Sampler() = default;
  virtual void start(int x, int y, uint64_t sample_index) = 0;
  virtual float get1d() = 0;
  virtual Vec2 get2d() = 0;
  virtual std::unique_ptr<Sampler> clone() const = 0;
  /// Samples per pixel that the scene asks for.
  virtual int samples_per_pixel() const = 0;
  virtual uint64_t seed() const = 0;
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
