#include "core/material.h"
#include "core/texture.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/lambertian.h"
#include "spectra/check_range.h"

namespace frond {
namespace {

constexpr Param kDiffuseTransmission[] = {
    {.name = "reflectance",
     .kind = ParamKind::spectrum_texture,
     .default_value = 0.25,
     .range = {0, 1},
     .doc = "Share of the light that is reflected."},
    {.name = "transmittance",
     .kind = ParamKind::spectrum_texture,
     .default_value = 0.25,
     .range = {0, 1},
     .doc = "Share of the light that is transmitted."},
    {.name = "scale",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .range = kAtLeastZero,
     .doc = "Factor on reflectance and transmittance."},
};

// Material "diffusetransmission": a Lambertian reflector and transmitter, the same on both sides. pbrt-v4 accepts
// shares whose sum exceeds 1; here they are scaled to conserve energy, with a warning.
class DiffuseTransmission final : public Material {
 public:
  explicit DiffuseTransmission(const Params& p)
      : reflectance_(p.spectrum_texture("reflectance")),
        transmittance_(p.spectrum_texture("transmittance")),
        scale_(static_cast<float>(p.real("scale"))),
        reflectance_where_(p.where("reflectance")),
        transmittance_where_(p.where("transmittance")) {
    constexpr float kRounding = 1e-5f;
    may_exceed_ = (reflectance_->max_value() + transmittance_->max_value()) * scale_ > 1 + kRounding;
    if (may_exceed_) warn_of_excess(p);
  }

  void prepare(const Preparation& preparation) override {
    check_range(reflectance_->range_nm(), preparation.wavelengths, reflectance_where_, "reflectance");
    check_range(transmittance_->range_nm(), preparation.wavelengths, transmittance_where_, "transmittance");
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const auto [r, t] = shares(hit.at, lambda);
    return arena.make<LambertianBsdf>(r, t);
  }
  bool is_reciprocal() const override { return true; }

 private:
  struct Shares {
    SampledSpectrum reflected, transmitted;
  };
  /// As given: their sum may exceed 1.
  Shares given_shares(const TexturePoint& at, const SampledWavelengths& lambda) const {
    const SampledSpectrum scale = scale_ * lane_mask(lambda);
    return {reflectance_->evaluate(at, lambda) * scale, transmittance_->evaluate(at, lambda) * scale};
  }
  /// Scaled to a sum of at most 1, lane by lane, which conserves energy.
  Shares shares(const TexturePoint& at, const SampledWavelengths& lambda) const {
    const Shares s = given_shares(at, lambda);
    if (!may_exceed_) return s;
    const SampledSpectrum least(1 / larger(s.reflected.v + s.transmitted.v, SampledSpectrum(1).v));
    return {s.reflected * least, s.transmitted * least};
  }

  /// Samples the sum every 2 nm, textures also at 16 x 16 points.
  void warn_of_excess(const Params& p) const {
    const Interval r = reflectance_->range_nm(), t = transmittance_->range_nm();
    // Constant spectra cover every wavelength: the range of leaf and lamp data is tested.
    const Interval both{std::max({r.min, t.min, 300.0}), std::min({r.max, t.max, 2500.0})};
    float most = 0;
    for (double nm = both.min; nm <= both.max; nm += 2)
      for (int place = 0; place < 256; ++place) {
        const int column = place % 16, row = place / 16;
        const TexturePoint at{{(static_cast<float>(column) + 0.5f) / 16, (static_cast<float>(row) + 0.5f) / 16}};
        const auto [reflected, transmitted] = given_shares(at, one_wavelength(static_cast<float>(nm)));
        most = std::max(most, reflected[0] + transmitted[0]);
      }
    if (most > 1)
      p.warn("reflectance", fmt::format("reflectance + transmittance reaches {:.4g}; where the sum exceeds 1, both are "
                                        "scaled down to a sum of 1",
                                        most));
  }

  static SampledWavelengths one_wavelength(float nm) {
    SampledWavelengths lambda;
    lambda.nm[0] = nm;
    lambda.pdf[0] = 1;
    lambda.active[0] = true;
    lambda.count = 1;
    return lambda;
  }

  std::shared_ptr<const SpectrumTexture> reflectance_, transmittance_;
  float scale_;
  bool may_exceed_;  ///< by bounds of both spectra, so that evaluate() skips the test for most materials
  Location reflectance_where_, transmittance_where_;
};

}  // namespace

extern const MaterialInfo diffuse_transmission_material{
    {"material", "diffusetransmission", "Lambertian reflector and transmitter.", "pbrt-v4", kDiffuseTransmission},
    make_material<DiffuseTransmission>};

}  // namespace frond
