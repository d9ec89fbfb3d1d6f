#pragma once

#include <span>

#include "leaf/solve/quadrature.h"

namespace frond::leaf {

/// Fourier modes over azimuth of a lobe max(0, cos alpha)^e, where the axis and the direction have given angles to the
/// normal.
class AzimuthModes {
 public:
  explicit AzimuthModes(double exponent);

  /// Stores the means over azimuth phi of lobe * cos(m phi), m = 0, 1, ... modes.size() - 1, in `modes`. mu_axis, mu in
  /// [0, 1]: cosines to the normal of the lobe's axis and of the direction, on the same side.
  void operator()(double mu_axis, double mu, std::span<double> modes) const;
  /// Returns mode 0 alone, the mean of the lobe over azimuth.
  double mean(double mu_axis, double mu) const;

 private:
  /// cos alpha = a + b cos phi, positive for |phi| < phi_max (radians).
  struct Angles {
    double a, b, phi_max;
    Angles(double mu_axis, double mu);
  };
  /// Means of the lobes of exponents e and e + 1.
  struct Means {
    double value, next;
  };
  Means means(const Angles& angles) const;
  Means direct(double power, const Angles& angles) const;
  /// Three-term recurrence in m (azimuth.cpp): forward is stable where the lobe is cut or nearly so, backward
  /// elsewhere.
  void forward(const Angles& angles, const Means& means, std::span<double> modes) const;
  void backward(const Angles& angles, const Means& means, std::span<double> modes) const;

  double exponent_, fraction_;
};

}  // namespace frond::leaf
