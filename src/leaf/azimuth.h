#pragma once

#include "leaf/quadrature.h"

namespace frond::leaf {

/// Mean over azimuth of a lobe's max(0, cos alpha)^e, for directions at given angles to the normal.
class AzimuthMean {
 public:
  explicit AzimuthMean(double exponent);

  /// mu_axis, mu in [0, 1]: cosines to the normal of the lobe's axis and of the direction, on the same side.
  double operator()(double mu_axis, double mu) const;

 private:
  double direct(double power, double a, double b, double phi_max) const;

  double exponent_, fraction_;
  std::vector<QuadratureNode> quadrature_;  ///< empty where the exponent is an integer
};

}  // namespace frond::leaf
