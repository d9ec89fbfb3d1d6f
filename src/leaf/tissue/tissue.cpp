#include "leaf/tissue/tissue.h"

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"

namespace frond::leaf {

TissueModel::TissueModel(const TissueParams& params)
    : params_(params),
      lobes_(
          std::make_shared<Lobes>(Lobes{TabulatedLobe(params.cuticle_aspect), TabulatedLobe(params.epidermis_aspect),
                                        TabulatedLobe(params.spongy_aspect), TabulatedLobe(params.palisade_aspect)})) {
  lobes_->at_interfaces = arrange(leaf_lobes());
  const double thickness = params.mesophyll_fraction * params.thickness_m;
  const std::vector<double> absorption = absorption_coefficients(params);
  for (size_t i = 0; i < kAbsorptionGrid.size(); ++i) {
    const Constants c = constants_at(kAbsorptionGrid.nm(i));
    const double n_cuticle =
        params.cuticle_refractivity == 1 ? c.n_cuticle : 1 + params.cuticle_refractivity * (c.n_cuticle - 1);
    optics_.push_back({n_cuticle, c.n_mesophyll, c.n_antidermal_wall, absorption[i] * thickness});
  }
}

TissueModel::Optics TissueModel::optics_at(double lambda_nm) const {
  const auto [i, t] = kAbsorptionGrid.cell(lambda_nm);
  const Optics &a = optics_[i], &b = optics_[i + 1];
  const double s = 1 - t;
  return {s * a.n_cuticle + t * b.n_cuticle, s * a.n_mesophyll + t * b.n_mesophyll,
          s * a.n_antidermal_wall + t * b.n_antidermal_wall, s * a.depth + t * b.depth};
}

Tissue TissueModel::at(double lambda_nm) const& { return build(optics_at(lambda_nm), lobes()); }

Tissue TissueModel::at(double lambda_nm, double optical_depth, const InterfaceLobes& lobes) const {
  Optics optics = optics_at(lambda_nm);
  optics.depth = optical_depth;
  return build(optics, lobes);
}

InterfaceLobes TissueModel::arrange(const LeafLobes& lobes) const {
  const auto [cut, epi, spo, pal] = lobes;
  constexpr const Lobe* none = nullptr;
  // Going down: reflected, refracted; going up: reflected, refracted.
  if (params_.structure == Structure::bifacial)
    return {{{{{cut, epi}, {epi, none}}},     // air, adaxial epidermis
             {{{epi, pal}, {pal, epi}}},      // adaxial epidermis, mesophyll
             {{{pal, spo}, {spo, pal}}},      // mesophyll, air space
             {{{none, none}, {none, none}}},  // air space, antidermal wall
             {{{none, epi}, {epi, none}}},    // antidermal wall, abaxial epidermis
             {{{epi, none}, {cut, epi}}}}};   // abaxial epidermis, air
  return {{{{{cut, epi}, {epi, none}}},       // air, adaxial epidermis
           {{{epi, spo}, {spo, epi}}},        // adaxial epidermis, mesophyll
           {{{spo, spo}, {spo, spo}}},        // mesophyll, air space
           {{{spo, spo}, {spo, spo}}},        // air space, mesophyll
           {{{spo, epi}, {epi, spo}}},        // mesophyll, abaxial epidermis
           {{{epi, none}, {cut, epi}}}}};     // abaxial epidermis, air
}

Tissue TissueModel::build(const Optics& optics, const InterfaceLobes& lobes) const {
  const auto [n_cuticle, n_mesophyll, n_antidermal_wall, depth] = optics;
  const bool bifacial = params_.structure == Structure::bifacial;
  return {.n = {1, n_cuticle, n_mesophyll, 1, bifacial ? n_antidermal_wall : n_mesophyll, n_cuticle, 1},
          .optical_depth = {0, 0, bifacial ? (1 - params_.spongy_share) * depth : depth, 0,
                            bifacial ? params_.spongy_share * depth : depth, 0, 0},
          .lobes = &lobes,
          .air_space_moves = !bifacial,
          .sieve_and_detour = params_.sieve_and_detour};
}

}  // namespace frond::leaf
