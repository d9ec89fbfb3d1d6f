#include "materials/conductor_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/roughness.h"

namespace frond {
namespace {

constexpr MetalNames kMetalNames{"eta", "k", "reflectance"};
constexpr auto kConductor =
    joined(metal_params(kMetalNames), roughness_params(kRoughnessNames), std::array{kRemapRoughness});

// Material "conductor": Trowbridge-Reitz facets with a metal's Fresnel reflectance.
class Conductor final : public Material {
 public:
  explicit Conductor(const Params& p) : metal_(p, kMetalNames), roughness_(p, kRoughnessNames) {}

  void prepare(const Preparation& preparation) override { metal_.prepare(preparation.wavelengths); }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<ConductorBsdf>(roughness_.at(hit.at), metal_.at(hit.at, lambda), lane_mask(lambda));
  }
  bool is_reciprocal() const override { return true; }
  bool needs_details() const override { return roughness_.has_direction(); }

 private:
  Metal metal_;
  Roughness roughness_;
};

}  // namespace

extern const MaterialInfo conductor_material{
    {"material", "conductor", "Metal, smooth or rough.", "Trowbridge and Reitz 1975; Heitz 2018; pbrt-v4", kConductor},
    make_material<Conductor>};

}  // namespace frond
