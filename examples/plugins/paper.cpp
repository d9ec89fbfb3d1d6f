#include "core/plugin_module.h"
#include "core/math/sampling.h"

namespace paper {
namespace {

using namespace frond;

constexpr Param kParams[] = {{.name = "reflectance",
                              .kind = ParamKind::spectrum_texture,
                              .default_value = 0.5,
                              .range = {0, 1},
                              .doc = "Share of the light that is reflected."}};

/// Reflects evenly, on both sides.
class PaperBsdf final : public Bsdf {
 public:
  explicit PaperBsdf(const SampledSpectrum& reflectance) : reflectance_(reflectance) {}

  Lobes flags() const override { return Lobes::reflection | Lobes::diffuse; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return same_side(wo, wi) ? reflectance_ * kInvPi : SampledSpectrum();
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    Vec3 wi = sample_cosine_hemisphere(u);
    if (wo.z < 0) wi.z = -wi.z;
    if (!same_side(wo, wi)) return {};
    return BsdfSample{f(wo, wi, rng), wi, pdf(wo, wi), flags()};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return same_side(wo, wi) ? std::abs(wi.z) * kInvPi : 0;
  }

 private:
  SampledSpectrum reflectance_;
};

class Paper final : public Material {
 public:
  explicit Paper(const Params& p) : reflectance_(p.spectrum_texture("reflectance")) {}
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    SampledSpectrum reflectance = reflectance_->evaluate(hit.at, lambda);
    for (int lane = 0; lane < kLanes; ++lane)
      if (!lambda.is_active(lane)) reflectance[lane] = 0;
    return arena.make<PaperBsdf>(reflectance);
  }
  bool is_reciprocal() const override { return true; }

 private:
  std::shared_ptr<const SpectrumTexture> reflectance_;
};

const MaterialInfo kPaper{{"material", "paper", "Lambertian reflector.", "", kParams}, make_material<Paper>};
const MaterialInfo* const kMaterials[] = {&kPaper};

}  // namespace
}  // namespace paper

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = paper::kMaterials};
  return &module;
}
