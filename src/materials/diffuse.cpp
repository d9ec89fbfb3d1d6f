#include "core/material.h"
#include "core/texture.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/lambertian.h"
#include "spectra/check_range.h"

namespace frond {
namespace {

constexpr Param kDiffuse[] = {
    {.name = "reflectance",
     .kind = ParamKind::spectrum_texture,
     .default_value = 0.5,
     .range = {0, 1},
     .doc = "Share of the light that is reflected."},
};

// Material "diffuse": a Lambertian reflector, the same on both sides.
class Diffuse final : public Material {
 public:
  explicit Diffuse(const Params& p) : reflectance_(p.spectrum_texture("reflectance")), where_(p.where("reflectance")) {}

  void prepare(const Preparation& preparation) override {
    check_range(reflectance_->range_nm(), preparation.wavelengths, where_, "reflectance");
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<LambertianBsdf>(reflectance_->evaluate(hit.at, lambda) * lane_mask(lambda), SampledSpectrum());
  }
  bool is_reciprocal() const override { return true; }

 private:
  std::shared_ptr<const SpectrumTexture> reflectance_;
  Location where_;
};

}  // namespace

extern const MaterialInfo diffuse_material{{"material", "diffuse", "Lambertian reflector.", "Lambert 1760", kDiffuse},
                                           make_material<Diffuse>};

}  // namespace frond
