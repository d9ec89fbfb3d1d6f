#include <numbers>

#include "core/plugin_module.h"
#include "core/math/sampling.h"
#include "spectra/check_range.h"

namespace soil {
namespace {

using namespace frond;

constexpr Param kParams[] = {
    {.name = "albedo",
     .kind = ParamKind::spectrum_texture,
     .default_value = 0.4,
     .range = {0, 1},
     .doc = "Share of the light that a grain scatters."},
    {.name = "asymmetry",
     .kind = ParamKind::real,
     .default_value = -0.2,
     .range = {-1, 1},
     .doc = "Mean cosine of the angle by which a grain turns light; below 0: back to where it came from. Not 1 or -1."},
};

/// Light that was scattered once on its way into and out of a deep layer of grains: Lommel's and Seeliger's law, with
/// the phase function of Henyey and Greenstein (1941) for one grain.
class SoilBsdf final : public Bsdf {
 public:
  SoilBsdf(const SampledSpectrum& albedo, float asymmetry) : albedo_(albedo), asymmetry_(asymmetry) {}

  Lobes flags() const override { return kLobes; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (!same_side(wo, wi)) return {};
    return albedo_ * (phase(-dot(wo, wi)) / (std::abs(wo.z) + std::abs(wi.z)));
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    Vec3 wi = sample_cosine_hemisphere(u);
    if (wo.z < 0) wi.z = -wi.z;
    if (!same_side(wo, wi)) return {};
    return BsdfSample{f(wo, wi, rng), wi, pdf(wo, wi), kLobes};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return same_side(wo, wi) ? std::abs(wi.z) * std::numbers::inv_pi_v<float> : 0;
  }

 private:
  static constexpr Lobes kLobes = Lobes::reflection | Lobes::diffuse;

  /// Per steradian, for the cosine of the angle by which light is turned.
  float phase(float cos_angle) const {
    const float g = asymmetry_, base = 1 + g * g - 2 * g * cos_angle;
    return (1 - g * g) * std::numbers::inv_pi_v<float> / (4 * base * std::sqrt(base));
  }

  SampledSpectrum albedo_;
  float asymmetry_;
};

class Soil final : public Material {
 public:
  explicit Soil(const Params& p)
      : albedo_(p.spectrum_texture("albedo")),
        albedo_where_(p.where("albedo")),
        asymmetry_(static_cast<float>(p.real("asymmetry"))) {
    if (std::abs(asymmetry_) == 1)
      fail(p.where("asymmetry"), "\"asymmetry\" is {}: light of one direction only; choose one between -1 and 1",
           asymmetry_);
  }

  void prepare(const Preparation& preparation) override {
    check_range(albedo_->range_nm(), preparation.wavelengths, albedo_where_, "albedo");
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    SampledSpectrum albedo = albedo_->evaluate(hit.at, lambda);
    for (int lane = 0; lane < kLanes; ++lane)
      if (!lambda.is_active(lane)) albedo[lane] = 0;
    return arena.make<SoilBsdf>(albedo, asymmetry_);
  }
  bool is_reciprocal() const override { return true; }

 private:
  std::shared_ptr<const SpectrumTexture> albedo_;
  Location albedo_where_;
  float asymmetry_;
};

const MaterialInfo kSoil{{"material", "soil", "Bare soil: light that its grains scatter once.",
                          "Seeliger 1887; Hapke 1981, Bidirectional Reflectance Spectroscopy", kParams},
                         make_material<Soil>};
const MaterialInfo* const kMaterials[] = {&kSoil};

}  // namespace
}  // namespace soil

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = soil::kMaterials};
  return &module;
}
