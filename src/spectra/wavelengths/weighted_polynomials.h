#pragma once

#include <functional>
#include <vector>

#include "spectra/cie.h"

namespace frond {

/// Returns the integral of f over kCieRange_nm by Gauss-Legendre quadrature with two points in each nanometre: exact if
/// f is a cubic between whole nanometres, as are products of linearly interpolated CIE tables.
double integrate_visible(const std::function<double(double nm)>& f);

/// Polynomials in wavelength that are orthogonal under a weight function, which may change its sign (Stieltjes'
/// procedure; Gautschi 2004, "Orthogonal Polynomials", section 2.2). Their roots are the nodes of the Gaussian
/// quadrature rules for that weight.
class WeightedPolynomials {
 public:
  /// Polynomials of degree 0 to `degree`; `weight` is a function of wavelength (nm).
  WeightedPolynomials(std::function<double(double nm)> weight, size_t degree);

  /// Value of the monic polynomial of degree n in (nm - 560) / 100.
  double at(size_t n, double nm) const;
  /// Returns the root (nm) of that polynomial to which Newton's method converges from `nm`.
  double root(size_t n, double nm) const;
  /// Returns the weights of the interpolatory quadrature rule on n points: it is exact for polynomials of degree n - 1,
  /// and of degree 2 n - 1 if the points are the roots of the polynomial of degree n.
  std::vector<double> rule(const std::vector<double>& points_nm) const;

 private:
  std::function<double(double)> weight_;
  /// Coefficients of the recurrence p[n + 1] = (x - a[n]) p[n] - b[n] p[n - 1].
  std::vector<double> a_, b_;
};

}  // namespace frond
