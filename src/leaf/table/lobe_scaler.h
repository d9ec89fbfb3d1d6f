#pragma once

#include <functional>
#include <vector>

namespace frond::leaf {

/// Makes a lobe p about the mirror direction, before its cut, reciprocal, such that it reflects a share R of the light
/// from each direction:
///   f(i, o) = R(i) / I(i) p(i, o) R(o) / I(o),   I(i) = integral of p(i, o) R(o) / I(o) |cos theta_o| over o.
/// A symmetric scaling as in leaf/table/reciprocal_modes.h. I is smooth in the cosine for any R and bounded from below;
/// hence so are the weights of samples of the lobe.
class LobeScaler {
 public:
  /// Prepares the computation of I at these cosines to the normal.
  LobeScaler(double exponent, const std::vector<double>& cosines);

  /// R, in [0, 1], by the cosine of a direction to the normal.
  using Reflectance = std::function<double(double)>;
  /// Returns I at the cosines; 1 if the lobe reflects nothing at all. Starts from the last call's result, so that calls
  /// with similar R converge faster.
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
