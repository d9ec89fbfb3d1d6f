#pragma once

#include <array>
#include <cmath>

#include "core/bsdf.h"
#include "core/math/sampling.h"
#include "materials/lobes/fresnel.h"

namespace frond {

/// exp(-x) I0(x) for x >= 0, I0 the modified Bessel function of order 0 (Abramowitz and Stegun, 9.8.1 and 9.8.2);
/// relative error below 5e-7.
inline float scaled_bessel_i0(float x) {
  const auto polynomial = [](float t, const auto& c) {
    float sum = 0;
    for (size_t i = std::size(c); i-- > 0;) sum = sum * t + c[i];
    return sum;
  };
  constexpr float kSplit = 3.75f;
  if (x < kSplit) {
    constexpr float kSmall[] = {1, 3.5156229f, 3.0899424f, 1.2067492f, 0.2659732f, 0.0360768f, 0.0045813f};
    const float t = x / kSplit;
    return polynomial(t * t, kSmall) * std::exp(-x);
  }
  constexpr float kLarge[] = {0.39894228f,  0.01328592f, 0.00225319f,  -0.00157565f, 0.00916281f,
                              -0.02057706f, 0.02635537f, -0.01647633f, 0.00392377f};
  return polynomial(kSplit / x, kLarge) / std::sqrt(x);
}

constexpr float integer_power(float x, unsigned n) {
  float product = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 != 0) product *= x;
  return product;
}

/// Form of a fibre and of the scales of its surface.
struct FiberForm {
  float offset;        ///< of the ray from the fibre's axis, over its radius; -1 to 1
  float eta;           ///< index of refraction, at least 1
  float beta_m;        ///< roughness along the fibre, above 0 up to 1
  float beta_n;        ///< roughness around the fibre, above 0 up to 1
  float tilt_radians;  ///< of the scales against the surface
};

/// Scattering by a fibre, a dielectric cylinder with a rough surface of tilted scales (Marschner et al. 2003; Chiang et
/// al. 2016, as in pbrt-v4). x is the direction of the fibre. Lobe p is the light that has passed the inside p times;
/// the last lobe is that of all further passes. A lobe is a share of the light (attenuation) times a density of the
/// angle theta against the plane normal to the fibre and one of the azimuth phi; both densities integrate to 1, so that
/// a fibre without absorption scatters all light. Not reciprocal: offset and attenuation belong to wo.
class HairBsdf final : public Bsdf {
 public:
  /// `absorption`: coefficient (natural logarithm) times the fibre's radius; `mask`: 1 in active lanes, else 0.
  HairBsdf(const FiberForm& form, const SampledSpectrum& absorption, const SampledSpectrum& mask)
      : offset_(form.offset), eta_(form.eta), absorption_(absorption), mask_(mask) {
    // Fits of Chiang et al. that make both roughnesses look even.
    const float m = form.beta_m, n = form.beta_n;
    const float deviation = 0.726f * m + 0.812f * m * m + 3.7f * integer_power(m, 20), variance = deviation * deviation;
    const std::array<float, kLobes> variances{variance, variance / 4, 4 * variance, 4 * variance};
    // Scales turn the lobes by -2, 1 and 4 times their tilt, the last one not.
    const float sine = std::sin(form.tilt_radians), cosine = std::cos(form.tilt_radians);
    const float sine2 = 2 * sine * cosine, cosine2 = 1 - 2 * sine * sine;
    const std::array<float, kLobes> sines{-sine2, sine, 2 * sine2 * cosine2, 0},
        cosines{cosine2, cosine, 1 - 2 * sine2 * sine2, 1};
    for (size_t p = 0; p < kLobes; ++p) {
      const float v = variances[p], floor = std::exp(-2 / v);
      along_[p] = {v, floor, 1 / (v * (1 - floor)), sines[p], cosines[p]};
    }
    constexpr float kRootOfPiOver8 = 0.626657069f;
    width_ = kRootOfPiOver8 * (0.265f * n + 1.194f * n * n + 5.372f * integer_power(n, 22));
    within_ = std::tanh(kPi / (2 * width_));
  }

  Lobes flags() const override { return Lobes::glossy | Lobes::reflection | Lobes::transmission; }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return wo.z == 0 || wi.z == 0 ? SampledSpectrum() : value(wi, Incidence(*this, wo)).f(wi);
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return wo.z == 0 || wi.z == 0 ? 0 : value(wi, Incidence(*this, wo)).pdf;
  }

  /// `uc` selects the lobe and, within its share, the azimuth; `u` the angle theta.
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream&) const override {
    if (wo.z == 0) return {};
    const Incidence in(*this, wo);
    size_t p = 0;
    float begin = 0;
    while (p + 1 < kLobes && uc >= begin + in.chances[p]) begin += in.chances[p++];
    if (!(in.chances[p] > 0)) return {};
    uc = remap_sample(uc, begin, begin + in.chances[p]);

    // A direction around the mirrored one, by an exponential distribution of the cosine between them.
    const auto [sine_o, cosine_o] = along_[p].turned(in.o);
    const float t = std::min(-along_[p].variance * std::log(u.x + (1 - u.x) * along_[p].floor), 2.f), cosine = 1 - t;
    const float sine = std::sqrt(t * (2 - t)), around = 2 * kPi * u.y, tilt = sine * std::cos(around);
    const float sine_i = tilt * cosine_o - cosine * sine_o;
    const float cosine_i = std::hypot(cosine * cosine_o + tilt * sine_o, sine * std::sin(around));
    const float phi = in.o.phi + (p + 1 < kLobes ? in.deflections[p] + sample_azimuth(uc) : 2 * kPi * uc);
    const Vec3 wi = normalize(Vec3{sine_i, cosine_i * std::cos(phi), cosine_i * std::sin(phi)});
    if (wi.z == 0) return {};
    const Value v = value(wi, in);
    if (!(v.pdf > 0)) return {};
    return BsdfSample{v.f(wi), wi, v.pdf,
                      Lobes::glossy | (same_side(wo, wi) ? Lobes::reflection : Lobes::transmission)};
  }

 private:
  static constexpr size_t kLobes = 4;

  /// A direction: angle against the plane normal to the fibre, and azimuth about the fibre.
  struct Direction {
    explicit Direction(const Vec3& w) : sine(w.x), cosine(std::hypot(w.y, w.z)), phi(std::atan2(w.z, w.y)) {}
    float sine, cosine, phi;
  };

  /// Scattering along the fibre, of one lobe (d'Eon et al. 2011).
  struct Along {
    float variance;
    float floor;  ///< exp(-2 / variance)
    float norm;   ///< 1 / (variance (1 - floor))
    float sine_turn, cosine_turn;

    struct Angle {
      float sine, cosine;
    };
    /// Angle of wo, turned by the tilt of the scales.
    Angle turned(const Direction& o) const {
      return {o.sine * cosine_turn + o.cosine * sine_turn, std::abs(o.cosine * cosine_turn - o.sine * sine_turn)};
    }
    /// Density of the sine of theta. The exponents of Bessel function and exponentials are summed first: each alone is
    /// large.
    float density(const Direction& i, const Angle& o) const {
      const float sines = i.sine + o.sine, cosines = i.cosine - o.cosine;
      return norm * scaled_bessel_i0(i.cosine * o.cosine / variance) *
             std::exp(-(sines * sines + cosines * cosines) / (2 * variance));
    }
  };

  /// What follows from wo.
  struct Incidence {
    Incidence(const HairBsdf& b, const Vec3& wo) : o(wo) {
      // The path inside: refracted along the fibre by eta, in the plane normal to it by a larger index.
      constexpr float kTiny = 1e-6f;
      const float sine_t = o.sine / b.eta_, cosine_t = std::sqrt(std::max(1 - sine_t * sine_t, kTiny * kTiny));
      const float sine_gamma_t = std::clamp(b.offset_ * o.cosine / (b.eta_ * cosine_t), -1.f, 1.f);
      const float cosine_gamma_t = std::sqrt(1 - sine_gamma_t * sine_gamma_t);
      const float gamma_o = std::asin(b.offset_), gamma_t = std::asin(sine_gamma_t);
      const float reflected = fresnel_dielectric(o.cosine * std::sqrt(1 - b.offset_ * b.offset_), b.eta_);
      SampledSpectrum passed;
      for (int lane = 0; lane < kLanes; ++lane)
        passed[lane] = std::exp(-b.absorption_[lane] * (2 * cosine_gamma_t / cosine_t));

      shares[0] = b.mask_ * reflected;
      shares[1] = b.mask_ * passed * ((1 - reflected) * (1 - reflected));
      shares[2] = shares[1] * passed * reflected;
      shares[3] =
          SampledSpectrum(shares[2].v * passed.v * reflected / larger(1 - passed.v * reflected, Float4{} + kTiny));
      float total = 0;
      for (size_t p = 0; p < kLobes; ++p) total += chances[p] = sum(shares[p].v);
      for (float& chance : chances) chance = total > 0 ? chance / total : 0;
      for (size_t p = 0; p + 1 < kLobes; ++p) deflections[p] = float(p) * (2 * gamma_t + kPi) - 2 * gamma_o;
    }

    Direction o;
    std::array<SampledSpectrum, kLobes> shares;   ///< of the light, by lobe; they sum to 1 without absorption
    std::array<float, kLobes> chances{};          ///< of sampling a lobe: its mean share over the lanes
    std::array<float, kLobes - 1> deflections{};  ///< azimuth of a lobe's light against that of wo, radians
  };

  /// f times the cosine of wi, and density.
  struct Value {
    SampledSpectrum f_cos;
    float pdf = 0;
    SampledSpectrum f(const Vec3& wi) const { return f_cos * (1 / std::max(std::abs(wi.z), 1e-30f)); }
  };
  Value value(const Vec3& wi, const Incidence& in) const {
    const Direction i(wi);
    Value v;
    for (size_t p = 0; p < kLobes; ++p) {
      const float azimuth = p + 1 < kLobes ? azimuth_density(i.phi - in.o.phi - in.deflections[p]) : 1 / (2 * kPi);
      const float density = along_[p].density(i, along_[p].turned(in.o)) * azimuth;
      v.f_cos += in.shares[p] * density;
      v.pdf += in.chances[p] * density;
    }
    return v;
  }

  /// Density of a difference of azimuths: a logistic distribution, cut off at -pi and pi.
  float azimuth_density(float difference) const {
    difference -= 2 * kPi * std::floor(difference / (2 * kPi) + 0.5f);
    const float e = std::exp(-std::abs(difference) / width_);
    return e / (width_ * (1 + e) * (1 + e) * within_);
  }
  /// Samples it, by the inverse of the distribution function.
  float sample_azimuth(float u) const {
    const float outside = (1 - within_) / 2;
    const float x = width_ * std::log((outside + u * within_) / (outside + (1 - u) * within_));
    return std::clamp(x, -kPi, kPi);
  }

  float offset_, eta_;
  SampledSpectrum absorption_, mask_;
  std::array<Along, kLobes> along_{};
  float width_;   ///< scale of the logistic distribution of azimuths, radians
  float within_;  ///< share of the logistic distribution between -pi and pi
};

}  // namespace frond
