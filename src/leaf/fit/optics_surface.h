#pragma once

#include <vector>

#include "core/parallel.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Reflectance and transmittance of a leaf of one structure, and how fast they change with its optical depth: all that
/// the leaf's chemistry can do to them. By a table over depth and refractive indices, which follow the wavelength.
class OpticsSurface {
 public:
  /// How fine: `coarse` is good to 1e-3, `fine` to 1e-4.
  enum class Grade { coarse, fine };

  /// Of `params` the structure counts, the walls' aspects and the sieve. Angles of incidence as in Shares; wavelengths
  /// from `first_nm` to `last_nm`.
  OpticsSurface(const TissueParams& params, const std::vector<double>& theta_deg, double first_nm, double last_nm,
                Grade grade, const ThreadPool& pool);

  struct Value {
    double r, t;              ///< all that is reflected, all that is transmitted
    double r_slope, t_slope;  ///< by the optical depth
  };
  /// `angle` counts in `theta_deg`; the optical depth is that of a straight way through the mesophyll.
  Value at(size_t angle, double lambda_nm, double depth) const;

 private:
  struct Pair {
    double r, t;
  };
  const Pair& node(size_t angle, size_t wavelength, size_t depth) const {
    return nodes_[(angle * wavelengths_nm_.size() + wavelength) * depth_count_ + depth];
  }

  std::vector<double> wavelengths_nm_;
  size_t depth_count_;
  std::vector<Pair> nodes_;  ///< [angle][wavelength][depth]
};

}  // namespace frond::leaf
