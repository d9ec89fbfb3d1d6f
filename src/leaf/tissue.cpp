#include "leaf/tissue.h"

#include "leaf/constants.h"

namespace frond::leaf {
namespace {

// Baranoski 2006 and Baranoski and Eng 2007.
constexpr Specimen kSpecimens[] = {
    {"soybean",
     "Soybean, a bifacial leaf.",
     {.structure = Structure::bifacial,
      .thickness_m = 1.66e-4,
      .mesophyll_fraction = 0.5,
      .chlorophyll_a = 3.9775,
      .chlorophyll_b = 1.1613,
      .carotenoids = 1.1323,
      .protein = 78.7059,
      .cellulose = 37.7565,
      .lignin = 10.7441,
      .cuticle_aspect = 5,
      .epidermis_aspect = 5,
      .spongy_aspect = 5,
      .palisade_aspect = 1}},
    {"maize",
     "Maize, a unifacial leaf.",
     {.structure = Structure::unifacial,
      .thickness_m = 2.04e-4,
      .mesophyll_fraction = 0.8,
      .chlorophyll_a = 2.895146,
      .chlorophyll_b = 0.79866,
      .carotenoids = 0.658895,
      .protein = 53.08714,
      .cellulose = 53.18709,
      .lignin = 6.05853,
      .cuticle_aspect = 10,
      .epidermis_aspect = 5,
      .spongy_aspect = 5,
      .palisade_aspect = 5}},
};

}  // namespace

std::span<const Specimen> specimens() { return kSpecimens; }

const Specimen* find_specimen(std::string_view name) {
  for (const Specimen& specimen : kSpecimens)
    if (specimen.name == name) return &specimen;
  return nullptr;
}

double absorption_coefficient(const TissueParams& p, double lambda_nm) {
  const Constants c = constants_at(lambda_nm);
  return (p.chlorophyll_a + p.chlorophyll_b) * c.chlorophyll + p.carotenoids * c.carotenoids + p.protein * c.protein +
         (p.cellulose + p.lignin) * c.cellulose + c.water;
}

TissueModel::TissueModel(const TissueParams& params)
    : params_(params),
      lobes_(std::make_shared<const Lobes>(Lobes{Lobe(params.cuticle_aspect), Lobe(params.epidermis_aspect),
                                                 Lobe(params.spongy_aspect), Lobe(params.palisade_aspect)})) {}

Tissue TissueModel::at(double lambda_nm) const {
  const Constants c = constants_at(lambda_nm);
  const double depth = absorption_coefficient(params_, lambda_nm) * params_.mesophyll_fraction * params_.thickness_m;
  const Lobe *cut = &lobes_->cuticle, *epi = &lobes_->epidermis, *spo = &lobes_->spongy, *pal = &lobes_->palisade;
  constexpr const Lobe* none = nullptr;
  const bool bifacial = params_.structure == Structure::bifacial;

  Tissue t{};
  t.owner = lobes_;
  t.sieve_and_detour = params_.sieve_and_detour;
  t.air_space_moves = !bifacial;
  // Going down: reflected, refracted; going up: reflected, refracted.
  if (bifacial) {
    t.n = {1, c.n_cuticle, c.n_mesophyll, 1, c.n_antidermal_wall, c.n_cuticle, 1};
    t.optical_depth = {0, 0, depth, 0, 0, 0, 0};
    t.lobes = {{{{{cut, epi}, {epi, none}}},     // air, adaxial epidermis
                {{{epi, pal}, {pal, epi}}},      // adaxial epidermis, mesophyll
                {{{pal, spo}, {spo, pal}}},      // mesophyll, air space
                {{{none, none}, {none, none}}},  // air space, antidermal wall
                {{{none, epi}, {epi, none}}},    // antidermal wall, abaxial epidermis
                {{{epi, none}, {cut, epi}}}}};   // abaxial epidermis, air
  } else {
    t.n = {1, c.n_cuticle, c.n_mesophyll, 1, c.n_mesophyll, c.n_cuticle, 1};
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
