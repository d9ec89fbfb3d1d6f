#include "materials/leaf_fluorescence.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "leaf/tissue/absorption.h"

namespace frond {

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
  // Walks run in double: cosines of grazing rays are small.
  return scale * transfer(normalize(to_double(wo)), normalize(to_double(wi)), emission_nm, excitation_nm, rng);
}

FluorescencePhotons LeafFluorescence::photons(const Vec3& wi, double emission_nm, double excitation_nm,
                                              RandomStream& rng) const {
  if (wi.z == 0) return {};
  const leaf::FluorescenceEnd end = transferred(normalize(to_double(wi)), emission_nm, excitation_nm, rng);
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

std::string MatrixFluorescence::emission_shape() const {
  return matrices_ ? "matrices of " + matrices_->name() : "none";
}

double MatrixFluorescence::f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm,
                             RandomStream&) const {
  if (!matrices_ || wo.z == 0 || wi.z == 0) return 0;
  const leaf::EmissionMatrices::Sides m = matrices_->at(emission_nm, excitation_nm, wi.z < 0);
  return ((wo.z > 0) == (wi.z > 0) ? m.lit : m.opposite) * std::numbers::inv_pi;
}

FluorescencePhotons MatrixFluorescence::photons(const Vec3& wi, double emission_nm, double excitation_nm,
                                                RandomStream&) const {
  if (!matrices_ || wi.z == 0) return {};
  const leaf::EmissionMatrices::Sides m = matrices_->at(emission_nm, excitation_nm, wi.z < 0);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return {kUnknown, kUnknown, kUnknown, m.lit, m.opposite};
}

std::shared_ptr<const Fluorescence> matrix_fluorescence(const LeafParams& leaf, const Log& log) {
  if (!leaf.matrices()) return nullptr;
  if (leaf.tissue().fluorescence > 0)
    log.warn(leaf.where(), "\"fluorescence\" has no effect with \"fluorescencematrices\"");
  return std::make_shared<const MatrixFluorescence>(leaf.matrices());
}

std::shared_ptr<const Fluorescence> only_matrix_fluorescence(const LeafParams& leaf, const Log& log) {
  if (auto given = matrix_fluorescence(leaf, log)) return given;
  if (leaf.tissue().fluorescence > 0)
    fail(leaf.where(),
         "fluorescence follows from tissue, which only abm and leaf_solved without \"tablefile\" walk through: use one "
         "of them, or give \"fluorescencematrices\"");
  return std::make_shared<const MatrixFluorescence>(nullptr);
}

}  // namespace frond
