#pragma once

#include <bit>
#include <numbers>
#include <stdexcept>

#include "core/material.h"
#include "core/math/sampling.h"

/// Materials that obey the laws, and the same ones with one defect each.
namespace frond::test {

/// Reflects and transmits evenly; obeys every law. The planted ones change one thing.
class Honest : public Bsdf {
 public:
  Honest(const SampledWavelengths& lambda, float r, float t) : r_(level(lambda, r)), t_(level(lambda, t)) {
    reflected_ = r + t > 0 ? r / (r + t) : 1;
  }

  Lobes flags() const override { return Lobes::reflection | Lobes::transmission | Lobes::diffuse; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override { return evaluate(wo, wi); }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (wo.z == 0) return {};
    Vec3 wi = warp(u);
    const bool reflects = uc < reflected_;
    if (reflects != (wo.z > 0)) wi.z = -wi.z;
    if (wi.z == 0) return {};
    return BsdfSample{f(wo, wi, rng), wi, pdf(wo, wi), sample_flags(reflects)};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return (same_side(wo, wi) ? reflected_ : 1 - reflected_) * std::abs(wi.z) * kInvPi;
  }

 protected:
  virtual Vec3 warp(Vec2 u) const { return sample_cosine_hemisphere(u); }
  virtual Lobes sample_flags(bool reflects) const {
    return Lobes::diffuse | (reflects ? Lobes::reflection : Lobes::transmission);
  }
  SampledSpectrum evaluate(const Vec3& wo, const Vec3& wi) const {
    if (wo.z == 0 || wi.z == 0) return {};
    return (same_side(wo, wi) ? r_ : t_) * kInvPi;
  }
  static SampledSpectrum level(const SampledWavelengths& lambda, float x) {
    SampledSpectrum s;
    for (int i = 0; i < lambda.count; ++i) s[i] = lambda.is_active(i) ? x : 0;
    return s;
  }

  SampledSpectrum r_, t_;
  float reflected_;
};

struct GoodLambertian final : Honest {
  explicit GoodLambertian(const SampledWavelengths& lambda) : Honest(lambda, 0.5f, 0.3f) {}
};
struct GoodLossless : Honest {
  explicit GoodLossless(const SampledWavelengths& lambda) : Honest(lambda, 0.6f, 0.4f) {}
};

/// The same BSDF, which says that it conserves the energy of light that arrives along wi.
template <class B>
struct FromLight final : B {
  using B::B;
  Lobes flags() const override { return B::flags() | Lobes::from_light; }
};

/// A lobe cos^e about the mirror direction; directions below the horizon are lost, and the density accounts for them.
template <int exponent, int claimed_exponent = exponent>
class NarrowLobe final : public Bsdf {
 public:
  explicit NarrowLobe(const SampledWavelengths& lambda) {
    for (int i = 0; i < lambda.count; ++i) level_[i] = lambda.is_active(i) ? 1 : 0;
  }

  Lobes flags() const override { return Lobes::reflection | Lobes::glossy; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return same_side(wo, wi) ? level_ * (pdf(wo, wi) / std::abs(wi.z)) : SampledSpectrum();
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    const float cos_a = std::pow(1 - u.x, 1.f / (exponent + 1)), sin_a = std::sqrt(1 - cos_a * cos_a);
    const float b = 2 * kPi * u.y;
    const Vec3 wi =
        normalize(Frame::around({-wo.x, -wo.y, wo.z}).to_world({sin_a * std::cos(b), sin_a * std::sin(b), cos_a}));
    if (!same_side(wo, wi) || pdf(wo, wi) == 0) return {};
    return BsdfSample{f(wo, wi, rng), wi, pdf(wo, wi), flags()};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (!same_side(wo, wi)) return 0;
    const float cos_a = std::min(1.f, wi.z * wo.z - wi.x * wo.x - wi.y * wo.y);
    return cos_a > 0 ? (claimed_exponent + 1) / (2 * kPi) * std::pow(cos_a, float(claimed_exponent)) : 0;
  }

 private:
  SampledSpectrum level_;
};
using GoodNarrowLobe = NarrowLobe<1000>;
using WrongExponent = NarrowLobe<1000, 900>;

/// A mirror with probability 0.3, else a uniform reflection.
class GoodCoatedDiffuse final : public Honest {
 public:
  explicit GoodCoatedDiffuse(const SampledWavelengths& lambda) : Honest(lambda, 0.7f, 0), mirror_(level(lambda, 1)) {}

  Lobes flags() const override { return Lobes::reflection | Lobes::diffuse | Lobes::specular; }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (uc >= kMirror) {
      auto s = Honest::sample(wo, 0, u, rng);
      if (s) s->pdf = pdf(wo, s->wi);
      return s;
    }
    if (wo.z == 0) return {};
    return BsdfSample{
        mirror_ * (kMirror / std::abs(wo.z)), {-wo.x, -wo.y, wo.z}, kMirror, Lobes::reflection | Lobes::specular};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override { return (1 - kMirror) * Honest::pdf(wo, wi); }

 private:
  static constexpr float kMirror = 0.3f;
  SampledSpectrum mirror_;
};

/// Like the random walks of leaves: f is noisy, a sample is in one random lane or absorbed, and the density is
/// approximate.
class GoodStochastic : public Honest {
 public:
  explicit GoodStochastic(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.3f), lambda_(lambda) {}

  Lobes flags() const override { return Honest::flags() | Lobes::stochastic; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    return evaluate(wo, wi) * (2 * rng.uniform());
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (uc >= 0.7f || wo.z == 0) return {};
    const bool reflects = uc < 0.4f;
    Vec3 wi = sample_cosine_hemisphere(u);
    if (reflects != (wo.z > 0)) wi.z = -wi.z;
    if (wi.z == 0) return {};
    const int lane = std::min(lambda_.count - 1, static_cast<int>(rng.uniform() * static_cast<float>(lambda_.count)));
    BsdfSample s{{}, wi, pdf(wo, wi), sample_flags(reflects) | Lobes::stochastic, true};
    if (lambda_.is_active(lane)) s.f[lane] = static_cast<float>(lambda_.count) * s.pdf / std::abs(wi.z);
    return s;
  }
  float pdf(const Vec3&, const Vec3& wi) const override { return std::abs(wi.z) * 0.5f * kInvPi; }

 private:
  SampledWavelengths lambda_;
};

// Defects, one each.

struct PdfWithoutProbability final : Honest {
  explicit PdfWithoutProbability(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  float pdf(const Vec3&, const Vec3& wi) const override { return std::abs(wi.z) * kInvPi; }
};

struct SampleGivesUp final : Honest {
  explicit SampleGivesUp(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    return rng.uniform() < 0.02f ? std::nullopt : Honest::sample(wo, uc, u, rng);
  }
};

struct ApproximatePdfTooLarge final : GoodStochastic {
  using GoodStochastic::GoodStochastic;
  float pdf(const Vec3&, const Vec3& wi) const override { return std::abs(wi.z) * 0.51f * kInvPi; }
};

struct HiddenTransmission final : Honest {
  explicit HiddenTransmission(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  Lobes flags() const override { return Lobes::reflection | Lobes::diffuse; }
};

struct FalseSampleFlag final : Honest {
  explicit FalseSampleFlag(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  Lobes sample_flags(bool) const override { return Lobes::diffuse | Lobes::reflection; }
};

struct LostEnergy : Honest {
  explicit LostEnergy(const SampledWavelengths& lambda) : Honest(lambda, 0.6f, 0.39f) {}
};

struct GainedEnergy : Honest {
  explicit GainedEnergy(const SampledWavelengths& lambda) : Honest(lambda, 0.6f, 0.41f) {}
};

struct WrongWarp final : Honest {
  explicit WrongWarp(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  Vec3 warp(Vec2 u) const override {
    const float sin_theta = std::sqrt(1 - u.x * u.x), phi = 2 * kPi * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), u.x};
  }
};

/// Half of all samples are reflected, where the density says three in five.
struct WrongLobeChoice final : Honest {
  explicit WrongLobeChoice(const SampledWavelengths& lambda) : Honest(lambda, 0.5f, 0.4f) {}
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    return Honest::sample(wo, uc < 0.5f ? 0 : 1, u, rng);
  }
};

struct SampleOfAnotherF final : Honest {
  explicit SampleOfAnotherF(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    auto s = Honest::sample(wo, uc, u, rng);
    if (s) s->f *= 1.01f;
    return s;
  }
};

struct NanAtGrazing final : Honest {
  explicit NanAtGrazing(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return evaluate(wo, wi) * (std::abs(wi.z) < 1e-6f ? std::numeric_limits<float>::quiet_NaN() : 1);
  }
};

struct ScattersAtZeroCosine final : Honest {
  explicit ScattersAtZeroCosine(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return (same_side(wo, wi) ? r_ : t_) * kInvPi;
  }
};

struct NegativeF final : Honest {
  explicit NegativeF(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return evaluate(wo, wi) * (wi.z > 0.9999f ? -1.f : 1.f);
  }
};

/// Still scatters in a retired lane; needs wavelengths with such a lane.
struct ThrowsAtGrazing final : Honest {
  explicit ThrowsAtGrazing(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (std::abs(wi.z) < 1e-6f) throw std::domain_error("cos theta is too small");
    return evaluate(wo, wi);
  }
};
struct WorksForRetiredLane final : Honest {
  explicit WorksForRetiredLane(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {
    for (int i = 0; i < lambda.count; ++i) t_[i] = 0.4f;
  }
};

struct OneWay final : Honest {
  explicit OneWay(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) {}
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return evaluate(wo, wi) * (1 - 0.1f * std::abs(wo.z));
  }
};

struct StochasticOneWay final : GoodStochastic {
  using GoodStochastic::GoodStochastic;
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    return GoodStochastic::f(wo, wi, rng) * (1 - 0.1f * std::abs(wo.z));
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    auto s = GoodStochastic::sample(wo, uc, u, rng);
    if (s) s->f *= 1 - 0.1f * std::abs(wo.z);
    return s;
  }
};

struct StochasticMissesAWayOut final : GoodStochastic {
  using GoodStochastic::GoodStochastic;
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    return same_side(wo, wi) ? GoodStochastic::f(wo, wi, rng) : SampledSpectrum();
  }
};

struct StochasticWrongByLittle final : GoodStochastic {
  using GoodStochastic::GoodStochastic;
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    return GoodStochastic::f(wo, wi, rng) * (wi.z > 0.5f ? 1.2f : 1);
  }
};

/// The noise is a hash of the direction, as layered BSDFs have it.
struct NoiseFromDirections final : GoodStochastic {
  using GoodStochastic::GoodStochastic;
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    RandomStream own(hash_key(std::bit_cast<uint32_t>(wi.x), std::bit_cast<uint32_t>(wi.y)));
    return evaluate(wo, wi) * (2 * own.uniform());
  }
};

/// f transmits, but samples and their density never do.
struct NeverSamplesTransmission final : Honest {
  explicit NeverSamplesTransmission(const SampledWavelengths& lambda) : Honest(lambda, 0.4f, 0.4f) { reflected_ = 1; }
};

/// A material without parameters that has this BSDF everywhere.
template <class B>
class Everywhere final : public Material {
 public:
  explicit Everywhere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<B>(lambda);
  }
};

template <class B>
MaterialInfo planted(std::string_view name, std::span<const Param> params = {}) {
  return {{"material", name, "Wrong on purpose.", "", params}, make_material<Everywhere<B>>};
}

}  // namespace frond::test
