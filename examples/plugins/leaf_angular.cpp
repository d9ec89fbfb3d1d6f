#include <numbers>

#include "core/plugin_module.h"
#include "core/math/sampling.h"
#include "leaf/table/lookup.h"
#include "leaf/table/table_cache.h"
#include "materials/leaf_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/table_wavelengths.h"

namespace leaf_angular {
namespace {

using namespace frond;

// A leaf model takes the parameters of all leaves, so that it can replace any other in a scene.
const std::vector<Param> kParams = without_reciprocal(leaf_params());

/// Lambertian reflection and transmission with the leaf's reflectance and transmittance at the angle of incidence.
class AngularBsdf final : public Bsdf {
 public:
  AngularBsdf(const leaf::TableLookup& table, const leaf::TableSelection& selection, const SampledSpectrum& active,
              bool from_light)
      : table_(table), selection_(selection), active_(active), from_light_(from_light) {}

  Lobes flags() const override { return from_light_ ? kLobes | Lobes::from_light : kLobes; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (wo.z * wi.z == 0) return {};
    const leaf::SampledShares shares = table_((from_light_ ? wi : wo).z, selection_);
    const bool reflects = wo.z * wi.z > 0;
    return active_ * (reflects ? shares.surface + shares.subsurface : shares.transmitted) *
           std::numbers::inv_pi_v<float>;
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    Vec3 wi = sample_cosine_hemisphere(u);
    const bool reflects = uc < 0.5f;
    if ((wo.z < 0) == reflects) wi.z = -wi.z;
    const float density = pdf(wo, wi);
    if (density == 0) return {};
    return BsdfSample{f(wo, wi, rng), wi, density,
                      Lobes::diffuse | (reflects ? Lobes::reflection : Lobes::transmission)};
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return wo.z * wi.z == 0 ? 0 : std::abs(wi.z) * std::numbers::inv_pi_v<float> / 2;
  }

 private:
  static constexpr Lobes kLobes = Lobes::reflection | Lobes::transmission | Lobes::diffuse;
  const leaf::TableLookup& table_;
  const leaf::TableSelection& selection_;
  SampledSpectrum active_;
  bool from_light_;
};

class AngularLeaf final : public Material {
 public:
  explicit AngularLeaf(const Params& p) : leaf_(p) {
    if (!leaf_.is_constant()) fail(p.where(), "\"leaf_angular\" takes no textures: use \"leaf_solved\"");
  }

  void prepare(const Preparation& preparation) override {
    leaf_.check_wavelengths(preparation.wavelengths);
    leaf::TableRequest request;
    request.params = leaf_.tissue();
    request.wavelengths_nm = table_wavelengths(preparation.wavelengths);
    const leaf::Table table = leaf::cached_table(request, leaf_.specimen(), preparation.pool, preparation.log,
                                                 preparation.cache_dir);
    table_ = preparation.wavelengths.fixed_nm().empty() ? leaf::TableLookup::for_spectra(table)
                                                        : leaf::TableLookup::for_lanes(table);
  }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    const auto* selection = arena.make<leaf::TableSelection>(table_.select(lambda));
    return arena.make<AngularBsdf>(table_, *selection, lane_mask(lambda), leaf_.incident() == Incident::light);
  }

 private:
  LeafParams leaf_;
  leaf::TableLookup table_;
};

// It approximates abm; a path takes 1.1 times as long as with leaf_lambert.
const MaterialInfo kAngularLeaf{
    {"material", "leaf_angular", "Lambertian leaf whose reflectance and transmittance depend on the angle of incidence.",
     "Baranoski and Rokne 1997 for the shares of light", kParams},
    make_material<AngularLeaf>,
    LeafModel{.reference = "abm", .cost = 1.1}};
const MaterialInfo* const kMaterials[] = {&kAngularLeaf};

}  // namespace
}  // namespace leaf_angular

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = leaf_angular::kMaterials};
  return &module;
}
