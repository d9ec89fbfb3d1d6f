#pragma once

#include <functional>
#include <string>

#include "core/spectrum.h"
#include "spectra/color/color_space.h"

namespace frond {

/// A smooth reflectance in (0, 1): a sigmoid of a quadratic in wavelength (Jakob and Hanika 2019), 360 to 830 nm.
class SigmoidPolynomial {
 public:
  /// Of t^2, t and 1, where t runs from -1 at 360 nm to 1 at 830 nm.
  constexpr explicit SigmoidPolynomial(const Triple& c)
      : c2_(static_cast<float>(c[0])), c1_(static_cast<float>(c[1])), c0_(static_cast<float>(c[2])) {}
  static SigmoidPolynomial of(float c2, float c1, float c0) {
    SigmoidPolynomial s{Triple{}};
    s.c2_ = c2, s.c1_ = c1, s.c0_ = c0;
    return s;
  }
  /// What it leaves of 1.
  SigmoidPolynomial complement() const { return of(-c2_, -c1_, -c0_); }
  float at(float lambda_nm) const {
    const float t = std::clamp((lambda_nm - 595) / 235, -1.f, 1.f);
    return sigmoid((c2_ * t + c1_) * t + c0_);
  }
  Float4 at(Float4 lambda_nm) const {
    constexpr Float4 kOne{1, 1, 1, 1};
    Float4 t = (lambda_nm - 595.f) / 235.f;
    t = t < -kOne ? -kOne : t > kOne ? kOne : t;
    const Float4 x = (c2_ * t + c1_) * t + c0_, size = larger(x, -x), r = square_root(kOne + x * x);
    const Float4 rest = 0.5f / (r * (r + size));
    return x < Float4{} ? rest : kOne - rest;
  }
  float max_value() const;
  /// As given to the constructor.
  Triple coefficients() const { return {double(c2_), double(c1_), double(c0_)}; }

 private:
  /// 1/2 + x / (2 sqrt(1 + x^2)), written so that no digits cancel where it is small.
  static float sigmoid(float x) {
    const float r = std::sqrt(1 + x * x);
    return x < 0 ? 0.5f / (r * (r - x)) : 0.5f + 0.5f * x / r;
  }
  float c2_, c1_, c0_;
};

struct SigmoidFit {
  SigmoidPolynomial reflectance;
  double error;  ///< largest difference in X, Y or Z under D65, where white has Y = 1
};

/// The reflectance that shows `rgb` in [0, 1] under D65, by damped Gauss-Newton steps; some tens of microseconds. No
/// reflectance is as bright and pure as the corners of wide spaces: there the error says what is missing.
SigmoidFit fit_reflectance(const ColorSpace& space, const Triple& rgb);

/// Moves the coefficients `c` (as of a SigmoidPolynomial) to those of `rgb`, faster and not as exact as
/// fit_reflectance: nodes are 5 nm apart. `from_flat`: beginning at those of a flat reflectance, whatever they are.
void refine_reflectance(const ColorSpace& space, const Triple& rgb, bool from_flat, Triple& c);

/// Largest error of a fit that the functions below accept, for the colour at full scale.
inline constexpr double kLargestFitError = 5e-3;

/// A reflectance. Where none has that colour it is the nearest, and `warn` is called. Throws InputError unless `rgb`
/// lies in [0, 1].
SpectrumPtr rgb_albedo(const ColorSpace& space, const Triple& rgb, const Location& where,
                       const std::function<void(const std::string&)>& warn);

/// A quantity of any size, index of refraction for one: a multiple of a reflectance. Throws InputError if a channel is
/// negative or no reflectance has that colour.
SpectrumPtr rgb_unbounded(const ColorSpace& space, const Triple& rgb, const Location& where);

/// An emission: a multiple of a reflectance times D65 of luminance 1, so that white (1, 1, 1) has Y = 1. Throws
/// InputError if a channel is negative or no light has that colour.
SpectrumPtr rgb_illuminant(const ColorSpace& space, const Triple& rgb, const Location& where);

}  // namespace frond
