#pragma once

#include <cmath>

namespace frond::leaf {

/// Reflection and refraction at a plane between two clear media.
struct Crossing {
  double reflectance;  ///< of unpolarised light; 1 past the critical angle
  double cos_t;        ///< cosine of the refracted direction, 0 past the critical angle
};

/// Returns Fresnel's reflectance and Snell's direction for light at `cos_i` > 0 from the normal; eta = n_from / n_to.
inline Crossing fresnel(double cos_i, double eta) {
  const double cos2_t = 1 - eta * eta * (1 - cos_i * cos_i);
  if (!(cos2_t > 0)) return {1, 0};
  const double cos_t = std::sqrt(cos2_t);
  const double s = eta * cos_i - cos_t, s_sum = eta * cos_i + cos_t;
  const double p = cos_i - eta * cos_t, p_sum = cos_i + eta * cos_t;
  // Half the sum of the squares of s / s_sum and p / p_sum, with one division.
  const double a = s * p_sum, b = p * s_sum, c = s_sum * p_sum;
  return {(a * a + b * b) / (2 * c * c), cos_t};
}

}  // namespace frond::leaf
