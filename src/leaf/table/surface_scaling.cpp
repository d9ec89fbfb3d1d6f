#include "leaf/table/surface_scaling.h"

#include <array>

#include "leaf/table/lobe_scaler.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

std::vector<double> arriving(LobeScaler& lobe, double index) {
  return lobe([index](double cosine) { return fresnel(cosine, 1 / index).reflectance; });
}

/// Coefficients of the cubic with these values at -1, -1/3, 1/3 and 1.
Float4 cubic(double a, double b, double c, double d) {
  const double even = (a + d) / 2, odd = (d - a) / 2, inner_even = (b + c) / 2, inner_odd = (c - b) / 2;
  const double square = (even - inner_even) * 9 / 8, cube = (odd - 3 * inner_odd) * 9 / 8;
  return Float4{static_cast<float>(even - square), static_cast<float>(odd - cube), static_cast<float>(square),
                static_cast<float>(cube)};
}

}  // namespace

SurfaceScaling::SurfaceScaling(const Interval& exponents, const Interval& indices) : axis_(exponents) {
  constexpr double kLeastWidth = 1e-6;  // narrower ranges count as one index
  const double middle = (indices.min + indices.max) / 2, width = (indices.max - indices.min) / 2;
  middle_ = static_cast<float>(middle);
  per_width_ = width > kLeastWidth ? static_cast<float>(1 / width) : 0;
  for (const double exponent : axis_.exponents()) {
    LobeScaler lobe(exponent, CosineNodes::cosines());
    if (per_width_ == 0) {
      for (const double value : arriving(lobe, middle)) cubics_.push_back(Float4{static_cast<float>(value), 0, 0, 0});
      continue;
    }
    std::array<std::vector<double>, 4> at;  // at -1, -1/3, 1/3, 1
    for (size_t i = 0; i < at.size(); ++i) at[i] = arriving(lobe, middle + width * (static_cast<double>(i) / 1.5 - 1));
    for (size_t k = 0; k < at[0].size(); ++k) cubics_.push_back(cubic(at[0][k], at[1][k], at[2][k], at[3][k]));
  }
}

}  // namespace frond::leaf
