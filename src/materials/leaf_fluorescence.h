#pragma once

#include <memory>
#include <vector>

#include "core/fluorescence.h"
#include "leaf/fluorescence/fluorescence_table.h"
#include "materials/leaf_params.h"

namespace frond {

/// Fluorescence of a leaf: yield and shape of the emission, and the share of the absorption that excites it. Where the
/// light goes in between follows from walks or from their solution.
class LeafFluorescence : public Fluorescence {
 public:
  explicit LeafFluorescence(const LeafParams& leaf);

  std::string emission_shape() const override { return emission_.name(); }
  bool is_black() const override { return tissue_.fluorescence == 0; }
  double f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm, RandomStream& rng) const override;
  FluorescencePhotons photons(const Vec3& wi, double emission_nm, double excitation_nm,
                              RandomStream& rng) const override;
  double excitation(double excitation_nm) const override;

 protected:
  /// Radiance over irradiance, 1/sr, if every absorption by anything leads to an emitted photon.
  virtual double transfer(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm,
                          RandomStream& rng) const = 0;
  /// The same as numbers of photons.
  virtual leaf::FluorescenceEnd transferred(const Vec3d& wi, double emission_nm, double excitation_nm,
                                            RandomStream& rng) const = 0;
  const leaf::TissueModel& model() const { return model_; }

 private:
  double share(double excitation_nm) const;
  double density(double emission_nm, double excitation_nm) const;

  leaf::TissueParams tissue_;
  leaf::TissueModel model_;
  leaf::EmissionShape emission_;
  std::vector<double> shares_;  ///< of the absorption that excites, at kAbsorptionGrid
};

/// Fluorescence by random walks, for `abm`.
class WalkedFluorescence final : public LeafFluorescence {
 public:
  WalkedFluorescence(const LeafParams& leaf, leaf::Absorption absorption)
      : LeafFluorescence(leaf), absorption_(absorption) {}
  bool is_noisy() const override { return true; }

 protected:
  double transfer(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm,
                  RandomStream& rng) const override;
  leaf::FluorescenceEnd transferred(const Vec3d& wi, double emission_nm, double excitation_nm,
                                    RandomStream& rng) const override;

 private:
  leaf::Absorption absorption_;
};

/// Fluorescence by their solution, for `leaf_solved`.
class SolvedFluorescence final : public LeafFluorescence {
 public:
  SolvedFluorescence(const LeafParams& leaf, std::shared_ptr<const leaf::FluorescenceTable> table)
      : LeafFluorescence(leaf), table_(std::move(table)) {}
  bool is_noisy() const override { return false; }

 protected:
  double transfer(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm,
                  RandomStream&) const override {
    return table_->f(wo, wi, emission_nm, excitation_nm);
  }
  leaf::FluorescenceEnd transferred(const Vec3d& wi, double emission_nm, double excitation_nm,
                                    RandomStream&) const override {
    return table_->photons(wi, emission_nm, excitation_nm);
  }

 private:
  std::shared_ptr<const leaf::FluorescenceTable> table_;
};

}  // namespace frond
