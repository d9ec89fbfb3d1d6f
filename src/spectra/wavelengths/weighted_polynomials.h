#pragma once

#include <functional>
#include <vector>

#include "spectra/cie.h"

namespace frond {

/// Integral over kCieRange_nm of what the eye's tables make smooth between whole nanometres: Gauss's rule with two
/// points in each, exact for cubics there.
double integrate_visible(const std::function<double(double nm)>& f);

/// Polynomials that are orthogonal under a weight function, which may change its sign (Stieltjes' procedure; Gautschi
/// 2004, "Orthogonal Polynomials", section 2.2). Their roots are the points of Gauss's rules for that weight.
class WeightedPolynomials {
 public:
  /// Up to `degree`.
  WeightedPolynomials(std::function<double(double nm)> weight, size_t degree);

  /// The monic polynomial of degree n.
  double at(size_t n, double nm) const;
  /// Its root nearest to where `nm` leads Newton's method.
  double root(size_t n, double nm) const;
  /// Weights of the rule on these points that is exact for polynomials of degree points - 1; of degree 2 points - 1
  /// where the points are the roots of the polynomial of that degree.
  std::vector<double> rule(const std::vector<double>& points_nm) const;

 private:
  /// p[n + 1] = (x - a[n]) p[n] - b[n] p[n - 1]
  std::function<double(double)> weight_;
  std::vector<double> a_, b_;
};

}  // namespace frond
