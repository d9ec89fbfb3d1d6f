#include "materials/leaf_fluorescence.h"

#include <cmath>

#include "leaf/tissue/absorption.h"

namespace frond {
namespace {

// Walks run in double: cosines of grazing rays are small.
Vec3d in_double(const Vec3& w) { return normalize(Vec3d{w.x, w.y, w.z}); }

}  // namespace

LeafFluorescence::LeafFluorescence(const LeafParams& leaf)
    : tissue_(leaf.tissue()), model_(tissue_), emission_(leaf.emission()) {
  for (size_t i = 0; i < leaf::kAbsorptionGrid.size(); ++i)
    shares_.push_back(leaf::fluorescing_share(tissue_, leaf::kAbsorptionGrid.nm(i)));
}

double LeafFluorescence::share(double excitation_nm) const {
  const auto [i, t] = leaf::kAbsorptionGrid.cell(excitation_nm);
  return std::lerp(shares_[i], shares_[i + 1], t);
}

double LeafFluorescence::density(double emission_nm, double excitation_nm) const {
  return leaf::emitted_density(tissue_.fluorescence, emission_, emission_nm, excitation_nm);
}

double LeafFluorescence::f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm,
                           RandomStream& rng) const {
  const double scale = share(excitation_nm) * density(emission_nm, excitation_nm);
  if (scale == 0 || wo.z == 0 || wi.z == 0) return 0;
  return scale * transfer(in_double(wo), in_double(wi), emission_nm, excitation_nm, rng);
}

FluorescencePhotons LeafFluorescence::photons(const Vec3& wi, double emission_nm, double excitation_nm,
                                              RandomStream& rng) const {
  if (wi.z == 0) return {};
  const leaf::FluorescenceEnd end = transferred(in_double(wi), emission_nm, excitation_nm, rng);
  const double absorbed = share(excitation_nm), scale = absorbed * density(emission_nm, excitation_nm);
  return {absorbed * end.emitted, scale * end.emitted, scale * end.reabsorbed, scale * end.left[0],
          scale * end.left[1]};
}

// The path of diffuse light through a layer is twice its thickness in the mean.
double LeafFluorescence::excitation(double excitation_nm) const {
  return -share(excitation_nm) * std::expm1(-2 * model_.at(excitation_nm).mesophyll_depth());
}

double WalkedFluorescence::transfer(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm,
                                    RandomStream& rng) const {
  const leaf::Tissue excited = model().at(excitation_nm), emitting = model().at(emission_nm);
  return leaf::estimate_fluorescence_f({excited, emitting}, wo, wi, absorption_, rng);
}

leaf::FluorescenceEnd WalkedFluorescence::transferred(const Vec3d& wi, double emission_nm, double excitation_nm,
                                                      RandomStream& rng) const {
  const leaf::Tissue excited = model().at(excitation_nm), emitting = model().at(emission_nm);
  return leaf::walk_fluorescence({excited, emitting}, wi, absorption_, rng);
}

}  // namespace frond
