#include "leaf/fit/bare_leaf.h"

#include "leaf/tissue/specimens.h"

namespace frond::leaf {
namespace {

const TissueModel& plain_model(Structure structure) {
  static const auto make = [](Structure of) {
    TissueParams params = specimen_of(of).params;
    params.cuticle_refractivity = 1;
    return TissueModel(params);
  };
  static const TissueModel bifacial = make(Structure::bifacial), unifacial = make(Structure::unifacial);
  return structure == Structure::bifacial ? bifacial : unifacial;
}

}  // namespace

BareLeaf::BareLeaf(const TissueParams& params)
    : plain_(plain_model(params.structure)),
      spongy_share_(params.spongy_share),
      refractivity_(params.cuticle_refractivity),
      sieve_(params.sieve_and_detour),
      lobes_(std::make_unique<Lobes>(Lobes{Lobe(params.cuticle_aspect), Lobe(params.epidermis_aspect),
                                           Lobe(params.spongy_aspect), Lobe(params.palisade_aspect)})) {
  lobes_->at_interfaces = plain_.arrange({&lobes_->cuticle, &lobes_->epidermis, &lobes_->spongy, &lobes_->palisade});
}

Tissue BareLeaf::at(double lambda_nm, double optical_depth) const {
  Tissue tissue = plain_.at(lambda_nm, optical_depth, lobes_->at_interfaces);
  for (const size_t epidermis : {1, 5})
    tissue.n[epidermis] = refractivity_ == 1 ? tissue.n[epidermis] : 1 + refractivity_ * (tissue.n[epidermis] - 1);
  if (!tissue.air_space_moves)
    tissue.optical_depth[2] = (1 - spongy_share_) * optical_depth,
    tissue.optical_depth[4] = spongy_share_ * optical_depth;
  tissue.sieve_and_detour = sieve_;
  return tissue;
}

}  // namespace frond::leaf
