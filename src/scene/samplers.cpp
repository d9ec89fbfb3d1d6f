#include <cmath>

#include "core/sampler.h"
#include "scene/registry.h"

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
     .doc = "Seed; --seed and the option of that name go before it."},
};

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

class IndependentSampler final : public SamplerBase {
 public:
  using SamplerBase::SamplerBase;
  void start(int x, int y, uint64_t index) override { stream_ = RandomStream(sample_key(seed(), x, y, index)); }
  float get1d() override { return stream_.uniform(); }
  Vec2 get2d() override {
    const float x = stream_.uniform();
    return {x, stream_.uniform()};
  }
  std::unique_ptr<Sampler> clone() const override { return std::make_unique<IndependentSampler>(*this); }

 private:
  RandomStream stream_{0};
};

constexpr uint32_t reverse_bits(uint32_t v) {
  v = __builtin_bswap32(v);
  v = (v & 0x0f0f0f0fu) << 4 | (v >> 4 & 0x0f0f0f0fu);
  v = (v & 0x33333333u) << 2 | (v >> 2 & 0x33333333u);
  return (v & 0x55555555u) << 1 | (v >> 1 & 0x55555555u);
}

/// Owen scrambling of a number whose bits are reversed, as a hash in which each bit depends on lower bits only: Laine
/// and Karras 2011, with the constants of Vegdahl 2021, "Building a Better LK Hash".
constexpr uint32_t owen_hash(uint32_t v, uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  return v ^ v * 0x53a22864u;
}

/// Second dimension of Sobol's sequence before the bit reversal: Pascal's triangle modulo 2 times the index. That
/// matrix is [[P, P], [0, P]] in its own halves, hence five steps.
constexpr uint32_t sobol_second(uint32_t v) {
  v ^= v >> 16;
  v ^= (v & 0xff00ff00u) >> 8;
  v ^= (v & 0xf0f0f0f0u) >> 4;
  v ^= (v & 0xccccccccu) >> 2;
  return v ^ (v & 0xaaaaaaaau) >> 1;
}

constexpr float to_unit(uint32_t v) { return static_cast<float>(v >> 8) * 0x1p-24f; }

/// The first two dimensions of Sobol's sequence, Owen-scrambled, padded: every request shuffles the sample order anew
/// (Burley 2020, "Practical Hash-based Owen Scrambling").
class PaddedSobolSampler final : public SamplerBase {
 public:
  using SamplerBase::SamplerBase;
  void start(int x, int y, uint64_t index) override {
    reversed_index_ = reverse_bits(static_cast<uint32_t>(index));
    pixel_key_ = sample_key(seed(), x, y, index >> 32);  // sequences of 2^32 samples, one after the other
    dimension_ = 0;
  }
  float get1d() override {
    const uint64_t key = next_key();
    const uint32_t index = shuffled_index(key);
    return to_unit(reverse_bits(owen_hash(index, static_cast<uint32_t>(mix64(key)))));
  }
  Vec2 get2d() override {
    const uint64_t key = next_key(), seeds = mix64(key);
    const uint32_t index = shuffled_index(key);
    return {to_unit(reverse_bits(owen_hash(index, static_cast<uint32_t>(seeds)))),
            to_unit(reverse_bits(owen_hash(sobol_second(index), static_cast<uint32_t>(seeds >> 32))))};
  }
  std::unique_ptr<Sampler> clone() const override { return std::make_unique<PaddedSobolSampler>(*this); }

 private:
  uint64_t next_key() { return mix64(pixel_key_ + ++dimension_ * 0x9e3779b97f4a7c15ull); }
  uint32_t shuffled_index(uint64_t key) const {
    return reverse_bits(owen_hash(reversed_index_, static_cast<uint32_t>(key >> 32)));
  }

  uint64_t pixel_key_ = 0, dimension_ = 0;
  uint32_t reversed_index_ = 0;
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
