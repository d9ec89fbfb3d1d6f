#pragma once

#include <memory>
#include <vector>

#include "core/fluorescence.h"
#include "core/log.h"
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

/// Fluorescence by matrices from a file, Lambertian on each side. What happens inside is unknown: the photons that are
/// absorbed, emitted inside and reabsorbed are NaN.
class MatrixFluorescence final : public Fluorescence {
 public:
  /// nullptr: black.
  explicit MatrixFluorescence(std::shared_ptr<const leaf::EmissionMatrices> matrices)
      : matrices_(std::move(matrices)) {}

  std::string emission_shape() const override;
  bool is_black() const override { return !matrices_; }
  bool is_noisy() const override { return false; }
  double f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm, RandomStream& rng) const override;
  FluorescencePhotons photons(const Vec3& wi, double emission_nm, double excitation_nm,
                              RandomStream& rng) const override;
  /// Returns the photons that leave both sides, in proportion to which light is absorbed.
  double excitation(double excitation_nm) const override { return matrices_ ? matrices_->emitted(excitation_nm) : 0; }

 private:
  std::shared_ptr<const leaf::EmissionMatrices> matrices_;
};

/// Returns the fluorescence of the leaf's matrices; nullptr if it has none. Warns of a yield, which has no effect.
std::shared_ptr<const Fluorescence> matrix_fluorescence(const LeafParams& leaf, const Log& log);

/// The same for a leaf without a model of fluorescence: black if it has no matrices. Throws InputError for a yield.
std::shared_ptr<const Fluorescence> only_matrix_fluorescence(const LeafParams& leaf, const Log& log);

}  // namespace frond
