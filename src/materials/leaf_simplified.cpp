#include "core/material.h"
#include "leaf/table_cache.h"
#include "materials/leaf_params.h"
#include "materials/lobes/three_lobe.h"

namespace frond {
namespace {

constexpr std::string_view kMethods[] = {"auto", "montecarlo", "solve"};
constexpr Param kOwn[] = {
    {.name = "oblateness",
     .kind = ParamKind::real,
     .range = {0, 1000},
     .doc = "Exponent of the surface lobe; by default cuticleaspect, so that abm has the same surface."},
    {.name = "surfacedirect",
     .kind = ParamKind::boolean,
     .default_value = true,
     .doc = "Light sampling sees the surface lobe; false, as published: only rays that follow the lobe do."},
    {.name = "tablemethod",
     .kind = ParamKind::string,
     .default_value = std::string_view("auto"),
     .doc = "How reflectance and transmittance are found: random walks, as published, or a solution without noise. "
            "auto: walks where the wavelengths are fixed, else the solution.",
     .choices = kMethods},
    {.name = "tablerays",
     .kind = ParamKind::integer,
     .default_value = 1000000,
     .range = {1, 1e9},
     .doc = "Walks for each degree of incidence."},
};
constexpr auto kLeafSimplified = with_leaf_params(kOwn);

/// Step of tables that are interpolated, nm. At 2.5 nm the error stays below 8e-4, at the red edge; its mean is 5e-5.
constexpr double kStep_nm = 2.5;

std::vector<double> table_wavelengths(const WavelengthStrategy& strategy) {
  const auto fixed = strategy.fixed_nm();
  if (!fixed.empty()) return {fixed.begin(), fixed.end()};
  const Interval range = strategy.range_nm();
  std::vector<double> grid;
  const auto first = static_cast<int>(std::floor(range.min / kStep_nm));
  const auto last = std::max(first + 1, static_cast<int>(std::ceil(range.max / kStep_nm)));
  for (int i = first; i <= last; ++i) grid.push_back(i * kStep_nm);
  return grid;
}

class LeafSimplified final : public Material {
 public:
  explicit LeafSimplified(const Params& p)
      : leaf_(p),
        method_(p.string("tablemethod")),
        surface_(p.given("oblateness") ? p.real("oblateness") : leaf_.tissue().cuticle_aspect),
        surface_direct_(p.boolean("surfacedirect")) {
    if (!leaf_.depth().is_constant() || leaf_.cuticle_aspect() || leaf_.epidermis_aspect() || leaf_.spongy_aspect() ||
        leaf_.palisade_aspect())
      fail(p.where(), "leaf_simplified takes no textures: abm does");
    if (leaf_.from_light()) fail(p.where("incident"), "leaf_simplified takes \"traced\" alone: abm takes \"light\"");
    request_.params = leaf_.tissue();
    request_.rays = p.integer("tablerays");
  }

  void prepare(const Preparation& preparation) override {
    leaf_.check_wavelengths(preparation.wavelengths);
    const bool fixed = !preparation.wavelengths.fixed_nm().empty();
    const bool walks = method_ == "montecarlo" || (method_ == "auto" && fixed);
    leaf::TableRequest request = request_;
    request.method = walks ? leaf::TableMethod::monte_carlo : leaf::TableMethod::solve;
    request.wavelengths_nm = table_wavelengths(preparation.wavelengths);
    if (request == request_) return;  // a mixture and the scene may both ask
    request_ = request;
    const leaf::Table table =
        leaf::cached_table(request_, leaf_.specimen(), preparation.pool, preparation.log, preparation.cache_dir);
    lookup_ = fixed ? leaf::TableLookup::for_lanes(table) : leaf::TableLookup::for_spectra(table);
  }

  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<ThreeLobeBsdf>(lookup_, surface_, lambda, surface_direct_);
  }

  bool is_leaf() const override { return true; }

 private:
  LeafParams leaf_;
  std::string method_;
  leaf::TableRequest request_;
  leaf::TableLookup lookup_;
  leaf::TabulatedLobe surface_;
  bool surface_direct_;
};

}  // namespace

extern const MaterialInfo leaf_simplified_material{
    {"material", "leaf_simplified", "Leaf by three lobes, scaled by a table of its reflectance and transmittance.",
     "Baranoski and Rokne, A Simplified Model for Light Interaction with Plant Tissue", kLeafSimplified},
    make_material<LeafSimplified>};

}  // namespace frond
