#pragma once

#include <vector>

#include "core/parallel.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Reflectance and transmittance of a leaf of one structure, and their derivatives with respect to its optical depth,
/// through which alone the leaf's chemistry acts. Interpolates in a table over depth and wavelength, which determines
/// the refractive indices.
class OpticsSurface {
 public:
  /// Accuracy of R and T: `coarse` 1e-3, `fine` 1e-4.
  enum class Grade { coarse, fine };

  /// Uses the structure, the aspect ratios of the walls and the sieve effect of `params`. Angles of incidence as in
  /// `solve` (leaf/solve/solver.h), degrees in [0, 180]; wavelengths from `first_nm` to `last_nm`.
  OpticsSurface(const TissueParams& params, const std::vector<double>& theta_deg, double first_nm, double last_nm,
                Grade grade, const ThreadPool& pool);

  /// R and T at one angle, wavelength and depth.
  struct Value {
    double r, t;              ///< shares of the incident light that are reflected and transmitted
    double r_slope, t_slope;  ///< derivatives with respect to the optical depth
  };
  /// `angle` is an index in `theta_deg`; `depth` is the optical depth of the mesophyll along the leaf's normal.
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
