#include <algorithm>
#include <array>

#include "core/sampler.h"

namespace frond {
namespace {

constexpr Param kSamplerParams[] = {
    {.name = "pixelsamples",
     .kind = ParamKind::integer,
     .default_value = 16,
     .range = {1, 1 << 30},
     .doc = "Samples per pixel."},
    {.name = "seed",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2147483647},
     .doc = "Seed; --seed and Option \"seed\" override it."},
};

/// Number of samples and seed, which all samplers have.
class SamplerBase : public Sampler {
 public:
  SamplerBase(const Params& p, std::optional<uint64_t> seed)
      : samples_per_pixel_(p.integer("pixelsamples")), seed_(seed.value_or(static_cast<uint64_t>(p.integer("seed")))) {}
  int samples_per_pixel() const override { return samples_per_pixel_; }

  uint64_t seed() const override { return seed_; }

 private:
  int samples_per_pixel_;
  uint64_t seed_;
};

/// Independent random numbers, a pure function of seed, pixel, sample and dimension.
class IndependentSampler final : public SamplerBase {
 public:
  using SamplerBase::SamplerBase;
  void get1d(const PixelSamples& samples, uint32_t dimension, float* u) const override {
    for (uint32_t i = 0; i < samples.count; ++i) u[i] = stream(samples, i, dimension).uniform();
  }
  void get2d(const PixelSamples& samples, uint32_t dimension, Vec2* u) const override {
    for (uint32_t i = 0; i < samples.count; ++i) {
      RandomStream numbers = stream(samples, i, dimension);
      u[i].x = numbers.uniform();
      u[i].y = numbers.uniform();
    }
  }

 private:
  /// Each sample and dimension has its own stream, so that a sample does not depend on which others are rendered.
  RandomStream stream(const PixelSamples& samples, uint32_t i, uint32_t dimension) const {
    return RandomStream(hash_key(sample_key(seed(), samples.x, samples.y, samples.first + i), dimension));
  }
};

/// Reverses the order of 32 bits by swapping halves.
constexpr uint32_t reverse_bits(uint32_t v) {
  v = v << 16 | v >> 16;
  v = (v & 0x00ff00ffu) << 8 | (v >> 8 & 0x00ff00ffu);
  v = (v & 0x0f0f0f0fu) << 4 | (v >> 4 & 0x0f0f0f0fu);
  v = (v & 0x33333333u) << 2 | (v >> 2 & 0x33333333u);
  return (v & 0x55555555u) << 1 | (v >> 1 & 0x55555555u);
}

/// Owen scrambling of a bit-reversed number, by a hash in which each bit depends only on lower bits: Laine and Karras
/// 2011, with the constants of Vegdahl 2021, "Building a Better LK Hash".
constexpr uint32_t owen_hash(uint32_t v, uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  return v ^ v * 0x53a22864u;
}

/// Second dimension of Sobol's sequence before the bit reversal: Pascal's triangle modulo 2 times the index. The matrix
/// has the block form [[P, P], [0, P]] recursively, hence five steps.
constexpr uint32_t sobol_second(uint32_t v) {
  v ^= v >> 16;
  v ^= (v & 0xff00ff00u) >> 8;
  v ^= (v & 0xf0f0f0f0u) >> 4;
  v ^= (v & 0xccccccccu) >> 2;
  return v ^ (v & 0xaaaaaaaau) >> 1;
}

constexpr float to_unit(uint32_t v) { return static_cast<float>(v >> 8) * 0x1p-24f; }

/// Scrambling of one dimension of one pixel.
struct Scramble {
  uint32_t order, seed_first, seed_second;

  /// Returns the position of a sample in the sequence, with reversed bits.
  uint32_t place(uint32_t index) const { return reverse_bits(owen_hash(reverse_bits(index), order)); }
  float first(uint32_t place) const { return to_unit(reverse_bits(owen_hash(place, seed_first))); }
  float second(uint32_t place) const { return to_unit(reverse_bits(owen_hash(sobol_second(place), seed_second))); }
};

/// Number of samples generated at once: the compiler vectorizes loops of this length.
constexpr uint32_t kBlock = 16;

/// Generates kBlock samples of one dimension.
[[gnu::always_inline]] inline void make_block(const Scramble& s, uint32_t index, float* u) {
  for (uint32_t i = 0; i < kBlock; ++i) u[i] = s.first(s.place(index + i));
}
/// Generates kBlock samples of a pair of dimensions. x and y are separate arrays for vectorization.
[[gnu::always_inline]] inline void make_block(const Scramble& s, uint32_t index, Vec2* u) {
  std::array<float, kBlock> x, y;
  for (uint32_t i = 0; i < kBlock; ++i) {
    const uint32_t place = s.place(index + i);
    x[i] = s.first(place);
    y[i] = s.second(place);
  }
  for (uint32_t i = 0; i < kBlock; ++i) u[i] = {x[i], y[i]};
}

/// Same code for wider instructions, selected at run time. Integer operations give identical bits.
template <class T>
void block_any(const Scramble& s, uint32_t index, T* u) {
  make_block(s, index, u);
}
#if defined(__x86_64__)
template <class T>
[[gnu::target("avx2")]] void block_avx2(const Scramble& s, uint32_t index, T* u) {
  make_block(s, index, u);
}
template <class T>
void block(const Scramble& s, uint32_t index, T* u) {
  static const auto make = __builtin_cpu_supports("avx2") ? block_avx2<T> : block_any<T>;
  make(s, index, u);
}
#else
template <class T>
void block(const Scramble& s, uint32_t index, T* u) {
  block_any(s, index, u);
}
#endif

void one(const Scramble& s, uint32_t index, float& u) { u = s.first(s.place(index)); }
/// Generates a single sample; used for the remainder of a block.
void one(const Scramble& s, uint32_t index, Vec2& u) {
  const uint32_t place = s.place(index);
  u = {s.first(place), s.second(place)};
}

/// The first two dimensions of Sobol's sequence, Owen-scrambled and padded: every dimension or pair shuffles the sample
/// order (Burley 2020, "Practical Hash-based Owen Scrambling").
class PaddedSobolSampler final : public SamplerBase {
 public:
  using SamplerBase::SamplerBase;
  void get1d(const PixelSamples& samples, uint32_t dimension, float* u) const override { get(samples, dimension, u); }
  void get2d(const PixelSamples& samples, uint32_t dimension, Vec2* u) const override { get(samples, dimension, u); }

 private:
  template <class T>
  void get(const PixelSamples& samples, uint32_t dimension, T* u) const {
    for (uint32_t at = 0; at < samples.count;) {
      const uint64_t index = samples.first + at;
      const auto first = uint32_t(index);  // sequences of 2^32 samples are concatenated
      const auto end = uint32_t(std::min<uint64_t>(samples.count, at + ((uint64_t{1} << 32) - first)));
      const Scramble s = scramble(samples, index >> 32, dimension);
      uint32_t i = at;
      for (; i + kBlock <= end; i += kBlock) block(s, first + (i - at), u + i);
      for (; i < end; ++i) one(s, first + (i - at), u[i]);
      at = end;
    }
  }
  /// Returns independent seeds for the order and for both dimensions, from the pixel and the dimension.
  Scramble scramble(const PixelSamples& samples, uint64_t sequence, uint32_t dimension) const {
    const uint64_t pixel = sample_key(seed(), samples.x, samples.y, sequence);
    const uint64_t key = mix64(pixel + (uint64_t(dimension) + 1) * 0x9e3779b97f4a7c15ull), seeds = mix64(key);
    return {uint32_t(key >> 32), uint32_t(seeds), uint32_t(seeds >> 32)};
  }
};

template <class T>
std::unique_ptr<Sampler> make_sampler(const Params& p, std::optional<uint64_t> seed) {
  return std::make_unique<T>(p, seed);
}

}  // namespace

extern const SamplerInfo independent_sampler{
    {"sampler", "independent", "Independent uniform random numbers.", "", kSamplerParams},
    make_sampler<IndependentSampler>};
extern const SamplerInfo padded_sobol_sampler{
    {"sampler", "paddedsobol", "Owen-scrambled Sobol' points, shuffled anew for each pair of dimensions.",
     "Burley 2020, Practical Hash-based Owen Scrambling", kSamplerParams},
    make_sampler<PaddedSobolSampler>};

}  // namespace frond
