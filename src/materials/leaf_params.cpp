#include "materials/leaf_params.h"

namespace frond {

leaf::TissueParams leaf_params(const Params& p) {
  leaf::TissueParams t = leaf::find_specimen(p.string("specimen"))->params;
  const auto override_by = [&p](double& value, std::string_view name) {
    if (p.given(name)) value = p.real(name);
  };
  override_by(t.thickness_m, "thickness");
  override_by(t.mesophyll_fraction, "mesophyllfraction");
  override_by(t.chlorophyll_a, "chlorophylla");
  override_by(t.chlorophyll_b, "chlorophyllb");
  override_by(t.carotenoids, "carotenoids");
  override_by(t.protein, "protein");
  override_by(t.cellulose, "cellulose");
  override_by(t.lignin, "lignin");
  override_by(t.cuticle_aspect, "cuticleaspect");
  override_by(t.epidermis_aspect, "epidermisaspect");
  override_by(t.spongy_aspect, "spongyaspect");
  override_by(t.palisade_aspect, "palisadeaspect");
  t.sieve_and_detour = p.boolean("sieve");
  return t;
}

}  // namespace frond
