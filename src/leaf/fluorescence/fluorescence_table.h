#pragma once

#include <vector>

#include "core/math/vec.h"
#include "core/parallel.h"
#include "leaf/fluorescence/fluorescence_walk.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Fluorescence of a leaf without noise, solved every 5 nm of excitation and emission and on a grid even in the sines
/// of both angles; linear between the wavelengths, cubic between the sines. Share of the
/// absorption, yield and spectrum are no part of it (leaf/fluorescence/fluorescence_walk.h).
class FluorescenceTable {
 public:
  /// Solves the table, on all threads of the pool; bitwise equal for any number.
  FluorescenceTable(const TissueParams& params, const ThreadPool& pool);

  /// The mean of walk_fluorescence. Wavelengths within kEmission_nm and kExcitation_nm.
  FluorescenceEnd photons(const Vec3d& wi, double emission_nm, double excitation_nm) const;
  /// The mean of estimate_fluorescence_f.
  double f(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm) const;

 private:
  /// Values of one pair of wavelengths and one lit side: [incident sine][value].
  const float* pair(size_t excitation, size_t emission, bool from_below) const {
    return &values_[((excitation * emissions_ + emission) * 2 + size_t(from_below)) * per_pair_];
  }
  /// Sum over the four neighbouring pairs of wavelengths, times their weights.
  template <class At>
  double between(double emission_nm, double excitation_nm, const At& at) const;

  TissueModel model_;
  size_t emissions_, per_sine_, per_pair_;
  std::vector<float> values_;
  std::vector<float> absorbed_;  ///< of the light that has entered: [excitation][from below][incident sine]
};

}  // namespace frond::leaf
