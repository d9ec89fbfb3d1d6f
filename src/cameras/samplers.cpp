#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

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

/// Converts to [0, 1). Only the upper 24 bits are used, which a float represents exactly, so that 1 cannot result.
constexpr float to_unit(uint32_t v) { return static_cast<float>(v >> 8) * 0x1p-24f; }

/// Numbers of one dimension, or a pair of dimensions, of a pixel's samples: sample i is the point
/// radical_inverse(i) (generator_x, generator_y) + shift, modulo 1 in units of 2^-32.
struct Lattice {
  uint32_t shuffle_seed;                                ///< 0: the samples are not shuffled
  uint32_t generator_x, generator_y, shift_x, shift_y;  ///< fixed-point fractions, units of 2^-32

  /// Radical inverse in base 2 of the sample's index, after the shuffle.
  template <bool kShuffles>
  uint32_t radical_inverse(uint32_t index) const {
    const uint32_t inverse = reverse_bits(index);
    return kShuffles ? owen_hash(inverse, shuffle_seed) : inverse;
  }
  float x(uint32_t inverse) const { return to_unit(inverse * generator_x + shift_x); }
  float y(uint32_t inverse) const { return to_unit(inverse * generator_y + shift_y); }
};

/// Number of samples generated at once: the compiler vectorizes loops of this length.
constexpr uint32_t kBlock = 16;

/// Generates kCount samples of one dimension.
template <uint32_t kCount, bool kShuffles>
[[gnu::always_inline]] inline void make(const Lattice& lattice, uint32_t index, float* u) {
  for (uint32_t i = 0; i < kCount; ++i) u[i] = lattice.x(lattice.radical_inverse<kShuffles>(index + i));
}
/// Generates kCount samples of a pair of dimensions. x and y are separate arrays for vectorization.
template <uint32_t kCount, bool kShuffles>
[[gnu::always_inline]] inline void make(const Lattice& lattice, uint32_t index, Vec2* u) {
  std::array<float, kCount> x, y;
  for (uint32_t i = 0; i < kCount; ++i) {
    const uint32_t inverse = lattice.radical_inverse<kShuffles>(index + i);
    x[i] = lattice.x(inverse);
    y[i] = lattice.y(inverse);
  }
  for (uint32_t i = 0; i < kCount; ++i) u[i] = {x[i], y[i]};
}
template <uint32_t kCount, class T>
[[gnu::always_inline]] inline void make(const Lattice& lattice, uint32_t index, T* u) {
  if (lattice.shuffle_seed == 0)
    make<kCount, false>(lattice, index, u);
  else
    make<kCount, true>(lattice, index, u);
}

/// Same code for wider instructions, selected at run time. Integer operations give identical bits.
template <class T>
void block_any(const Lattice& lattice, uint32_t index, T* u) {
  make<kBlock>(lattice, index, u);
}
#if defined(__x86_64__)
template <class T>
[[gnu::target("avx2")]] void block_avx2(const Lattice& lattice, uint32_t index, T* u) {
  make<kBlock>(lattice, index, u);
}
template <class T>
void block(const Lattice& lattice, uint32_t index, T* u) {
  static const auto function = __builtin_cpu_supports("avx2") ? block_avx2<T> : block_any<T>;
  function(lattice, index, u);
}
#else
template <class T>
void block(const Lattice& lattice, uint32_t index, T* u) {
  block_any(lattice, index, u);
}
#endif

/// An extensible rank-1 lattice: its first 2^n points are a lattice for each n. Most noise of an image comes from edges
/// in the pixel, in the light's shadow and between scattered directions; a lattice whose points are far apart estimates
/// their share with less variance than other points. Its noise would depend on an edge's orientation: it is therefore
/// reflected at random, beside the random shift that makes the estimate unbiased.
class LatticeSampler final : public SamplerBase {
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
      const Lattice numbers = lattice(samples, index >> 32, dimension);
      uint32_t i = at;
      for (; i + kBlock <= end; i += kBlock) block(numbers, first + (i - at), u + i);
      for (; i < end; ++i) make<1>(numbers, first + (i - at), u + i);
      at = end;
    }
  }

  /// Returns the lattice of a dimension: shift (Cranley and Patterson 1976), exchange of axes and reflection are
  /// random, as functions of seed, pixel and dimension.
  Lattice lattice(const PixelSamples& samples, uint64_t sequence, uint32_t dimension) const {
    // From a search: 2^n points of the generating vector (1, kSecond) have a small variance for random edges in a
    // pixel, for all n.
    constexpr uint32_t kSecond = 0x4da614d3;
    // A factor of all joint dimensions: 2^n samples remain the same points, in another order. With bands, a wavelength
    // has every 2^k-th sample (sample_for_index), whose radical inverses lie in one interval of length 2^-k; this
    // factor spreads them over the whole lattice. From a search for a small variance of edges by such samples.
    constexpr uint32_t kReorder = 0x9154fa29;
    const uint64_t pixel = sample_key(seed(), samples.x, samples.y, sequence);
    const uint64_t key = mix64(pixel + (uint64_t(dimension) + 1) * 0x9e3779b97f4a7c15ull), shifts = mix64(key);
    const uint32_t joint = factor(dimension);
    Lattice numbers{joint != 0 ? 0 : uint32_t(key >> 32) | 1u, joint != 0 ? joint * kReorder : 1, 0, uint32_t(shifts),
                    uint32_t(shifts >> 32)};
    numbers.generator_y = numbers.generator_x * kSecond;
    const bool is_pair = dimension != uint32_t(Dimension::wavelengths);
    if ((key & 1) && is_pair) std::swap(numbers.generator_x, numbers.generator_y);
    if (key & 2) numbers.generator_y = -numbers.generator_y;
    return numbers;
  }

  /// Factors of the dimensions, by Dimension, that form one lattice together; 0 for all others, which shuffle the
  /// samples. From searches for a small variance of random half-spaces of two and three pairs, and where the pair of
  /// the light or of the direction is drawn twice for each sample; that of the wavelengths, for half-spaces whose
  /// colour varies with them (measurements/run lattice).
  static constexpr uint32_t factor(uint32_t dimension) {
    constexpr uint32_t kWavelengths = 1077, kFilm = 1, kLens = 409, kTime = 2491, kOnLight = 887, kDirection = 6595;
    constexpr uint32_t kFactors[] = {kWavelengths, kFilm, kLens, kTime, 0, kOnLight, 0, kDirection};
    static_assert(std::size(kFactors) == size_t(Dimension::count));
    return dimension < std::size(kFactors) ? kFactors[dimension] : 0;
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
extern const SamplerInfo lattice_sampler{
    {"sampler", "lattice",
     "Points of a rank-1 lattice, shifted at random in each pixel: the numbers of the camera ray and of the first hit "
     "are well distributed together, those of later hits each for themselves.",
     "Cranley and Patterson 1976; Dammertz and Keller 2008, Image Synthesis by Rank-1 Lattices", kSamplerParams},
    make_sampler<LatticeSampler>};

}  // namespace frond
