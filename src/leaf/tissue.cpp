#include "leaf/tissue.h"

#include <algorithm>

#include "leaf/constants.h"

namespace frond::leaf {
namespace {

constexpr double kStep_nm = 5;

}  // namespace

double absorption_coefficient(const TissueParams& p, double lambda_nm) {
  const Constants c = constants_at(lambda_nm);
  return (p.chlorophyll_a + p.chlorophyll_b) * c.chlorophyll + p.carotenoids * c.carotenoids + p.protein * c.protein +
         (p.cellulose + p.lignin) * c.cellulose + c.water;
}

TissueModel::TissueModel(const TissueParams& params)
    : params_(params),
      lobes_(std::make_shared<const Lobes>(Lobes{Lobe(params.cuticle_aspect), Lobe(params.epidermis_aspect),
                                                 Lobe(params.spongy_aspect), Lobe(params.palisade_aspect)})) {
  const double thickness = params.mesophyll_fraction * params.thickness_m;
  for (double nm = kConstantsRange_nm.min; nm <= kConstantsRange_nm.max; nm += kStep_nm) {
    const Constants c = constants_at(nm);
    optics_.push_back(
        {c.n_cuticle, c.n_mesophyll, c.n_antidermal_wall, absorption_coefficient(params, nm) * thickness});
  }
}

TissueModel::Optics TissueModel::optics_at(double lambda_nm) const {
  const double x = (lambda_nm - kConstantsRange_nm.min) / kStep_nm;
  const auto below = std::min(static_cast<size_t>(std::max(0.0, x)), optics_.size() - 2);
  const double t = x - static_cast<double>(below), s = 1 - t;
  const Optics &a = optics_[below], &b = optics_[below + 1];
  return {s * a.n_cuticle + t * b.n_cuticle, s * a.n_mesophyll + t * b.n_mesophyll,
          s * a.n_antidermal_wall + t * b.n_antidermal_wall, s * a.depth + t * b.depth};
}

Tissue TissueModel::at(double lambda_nm) const& {
  const auto [n_cuticle, n_mesophyll, n_antidermal_wall, depth] = optics_at(lambda_nm);
  const Lobe *cut = &lobes_->cuticle, *epi = &lobes_->epidermis, *spo = &lobes_->spongy, *pal = &lobes_->palisade;
  constexpr const Lobe* none = nullptr;
  const bool bifacial = params_.structure == Structure::bifacial;

  Tissue t{};
  t.sieve_and_detour = params_.sieve_and_detour;
  t.air_space_moves = !bifacial;
  // Going down: reflected, refracted; going up: reflected, refracted.
  if (bifacial) {
    t.n = {1, n_cuticle, n_mesophyll, 1, n_antidermal_wall, n_cuticle, 1};
    t.optical_depth = {0, 0, depth, 0, 0, 0, 0};
    t.lobes = {{{{{cut, epi}, {epi, none}}},     // air, adaxial epidermis
                {{{epi, pal}, {pal, epi}}},      // adaxial epidermis, mesophyll
                {{{pal, spo}, {spo, pal}}},      // mesophyll, air space
                {{{none, none}, {none, none}}},  // air space, antidermal wall
                {{{none, epi}, {epi, none}}},    // antidermal wall, abaxial epidermis
                {{{epi, none}, {cut, epi}}}}};   // abaxial epidermis, air
  } else {
    t.n = {1, n_cuticle, n_mesophyll, 1, n_mesophyll, n_cuticle, 1};
    t.optical_depth = {0, 0, depth, 0, depth, 0, 0};
    t.lobes = {{{{{cut, epi}, {epi, none}}},    // air, adaxial epidermis
                {{{epi, spo}, {spo, epi}}},     // adaxial epidermis, mesophyll
                {{{spo, spo}, {spo, spo}}},     // mesophyll, air space
                {{{spo, spo}, {spo, spo}}},     // air space, mesophyll
                {{{spo, epi}, {epi, spo}}},     // mesophyll, abaxial epidermis
                {{{epi, none}, {cut, epi}}}}};  // abaxial epidermis, air
  }
  return t;
}

}  // namespace frond::leaf
