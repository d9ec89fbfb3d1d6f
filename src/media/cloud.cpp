#include "media/medium_params.h"
#include "media/null_collisions.h"
#include "textures/noise.h"

namespace frond {
namespace {

/// Box, density and coefficients; "frequency" is in cycles for each unit of medium space.
constexpr Param kCloud[] = {kBoxLow,
                            kBoxHigh,
                            {.name = "density",
                             .kind = ParamKind::real,
                             .default_value = 1.0,
                             .range = kAtLeastZero,
                             .doc = "Factor of the noise; the density itself is at most 1."},
                            {.name = "wispiness",
                             .kind = ParamKind::real,
                             .default_value = 1.0,
                             .range = kAtLeastZero,
                             .doc = "Strength of the noise that displaces the noise."},
                            {.name = "frequency",
                             .kind = ParamKind::real,
                             .default_value = 5.0,
                             .unit = "1/unit",
                             .range = kAtLeastZero,
                             .doc = "Frequency of the lowest octave."},
                            kSigmaA,
                            kSigmaS,
                            kMeanCosine};

/// Procedural cloud: the density is Perlin noise that decreases with the height y.
class Cloud final : public Medium {
 public:
  Cloud(const Params& p, const Transform& world_from_medium)
      : box_(medium_box(p, world_from_medium)),
        null_collisions_(box_.bounds(), world_from_medium, p.where()),
        coefficients_(p),
        phase_(Phase::henyey_greenstein(float(p.real("g")))),
        density_(float(p.real("density"))),
        wispiness_(float(p.real("wispiness"))),
        frequency_(float(p.real("frequency"))),
        largest_(largest_density()) {}

  /// Coefficients in 1/unit: those of density 1 times the density, which is 0 to 1.
  MediumPoint properties(const Vec3& p, const SampledWavelengths& lambda) const override {
    const float density = density_at(box_.world_to_local(p));
    return {coefficients_.sigma_a(lambda) * density, coefficients_.sigma_s(lambda) * density, {}, phase_};
  }
  /// One majorant for the whole box: a grid of majorants requires bounds of the noise in each cell.
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    return box_.steps(ray, nullptr, coefficients_.sigma_t(lambda) * largest_);
  }
  /// Throws InputError if the cloud is too thin for its majorant.
  void check(const WavelengthStrategy& wavelengths) const override { null_collisions_.check(*this, wavelengths); }

 private:
  /// Gradient of the noise by forward differences with step 0.01, as in pbrt-v4, for each unit of its lattice.
  static Vec3 gradient(const Vec3& p) {
    constexpr float kStep = 0.01f;
    const float at = perlin_noise(p);
    const auto along = [&](const Vec3& d) { return (perlin_noise(p + d) - at) / kStep; };
    return {along({kStep, 0, 0}), along({0, kStep, 0}), along({0, 0, kStep})};
  }
  /// pbrt-v4's density, with its constants.
  float density_at(const Vec3& p) const {
    // The point is displaced by the gradient of two octaves of noise, which gives wisps at the border.
    Vec3 at = p * frequency_;
    if (wispiness_ > 0) {
      float amplitude = 0.05f * wispiness_, frequency = 10;
      for (int octave = 0; octave < 2; ++octave, amplitude *= 0.5f, frequency *= 1.99f)
        at += gradient(at * frequency) * amplitude;
    }
    // Five octaves of Perlin noise. The ratio 1.99 rather than 2 keeps lattices of the octaves from coinciding.
    float noise = 0, amplitude = 0.5f, frequency = 1;
    for (int octave = 0; octave < 5; ++octave, amplitude *= 0.5f, frequency *= 1.99f)
      noise += amplitude * perlin_noise(at * frequency);
    // The density decreases with height and is 1 at y = 0, whatever the noise.
    const float thinned = std::clamp((1 - p.y) * 4.5f * density_ * noise, 0.f, 1.f);
    return std::clamp(thinned + 2 * std::max(0.f, 0.5f - p.y), 0.f, 1.f);
  }
  /// Upper bound of the density in the box: 1 unless `density` is small and the box is above y = 0.
  float largest_density() const {
    constexpr float kLargestNoise = 1.1f;  // of the sum of octaves, whose amplitudes sum to 0.97
    const float low = box_.bounds().min.y, high = box_.bounds().max.y;
    const float thinned = std::max(std::abs(1 - low), std::abs(1 - high)) * 4.5f * density_ * kLargestNoise;
    return std::min(1.f, thinned + 2 * std::max(0.f, 0.5f - low));
  }

  MediumBox box_;
  NullCollisionCheck null_collisions_;
  Coefficients coefficients_;
  Phase phase_;
  float density_, wispiness_, frequency_;
  float largest_;  ///< factor of the coefficients that gives the majorant
};

}  // namespace

extern const MediumInfo cloud_medium{{"medium", "cloud", "Procedural cloud.", "pbrt-v4", kCloud}, make_medium<Cloud>};

}  // namespace frond
