#pragma once

#include <functional>
#include <vector>

namespace frond::leaf {

/// Makes a lobe p about the mirror direction, before its cut, the same both ways round, so that it reflects a share R
/// of what comes along each direction:
///   f(i, o) = R(i) / I(i) p(i, o) R(o) / I(o),   I(i) = integral of p(i, o) R(o) / I(o) |cos theta_o| over o.
/// A symmetric scaling, as of leaf/table/reciprocal_modes.h. I is smooth in the cosine whatever R is, and bounded from
/// below: so are the weights of samples of the lobe.
class LobeScaler {
 public:
  /// For I at these cosines to the normal.
  LobeScaler(double exponent, const std::vector<double>& cosines);

  /// R, in [0, 1], by the cosine of a direction to the normal.
  using Reflectance = std::function<double(double)>;
  /// I. Where the lobe reflects nothing at all, 1. Quicker where R is like that of the last call.
  std::vector<double> operator()(const Reflectance& reflectance);

 private:
  struct Direction {
    double cosine;
    double weight;  ///< in the integral of |cos theta| over the hemisphere
  };
  std::vector<Direction> directions_;
  // Means of the lobe over azimuth.
  std::vector<double> lobes_;     ///< [direction][direction]
  std::vector<double> lobes_at_;  ///< [cosine][direction]
  std::vector<double> arriving_;  ///< I, by direction, of the last call
};

}  // namespace frond::leaf
