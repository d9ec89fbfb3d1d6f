#pragma once

#include <functional>
#include <string>

#include "core/spectrum.h"
#include "spectra/color/color_space.h"

namespace frond {

/// Smooth reflectance in (0, 1), 360 to 830 nm: a sigmoid of a quadratic polynomial in wavelength (Jakob and Hanika
/// 2019).
class SigmoidPolynomial {
 public:
  /// `c` are the coefficients of t^2, t and 1, where t is linear from -1 at 360 nm to 1 at 830 nm.
  constexpr explicit SigmoidPolynomial(const Triple& c)
      : c2_(static_cast<float>(c[0])), c1_(static_cast<float>(c[1])), c0_(static_cast<float>(c[2])) {}
  /// The same from single-precision coefficients of t^2, t and 1.
  static SigmoidPolynomial of(float c2, float c1, float c0) {
    SigmoidPolynomial s{Triple{}};
    s.c2_ = c2, s.c1_ = c1, s.c0_ = c0;
    return s;
  }
  /// Returns 1 minus this reflectance.
  SigmoidPolynomial complement() const { return of(-c2_, -c1_, -c0_); }
  /// Value at a wavelength; outside 360 to 830 nm, the value at the nearest end.
  float at(float lambda_nm) const {
    const float t = std::clamp((lambda_nm - 595) / 235, -1.f, 1.f);
    return sigmoid((c2_ * t + c1_) * t + c0_);
  }
  /// The same for four wavelengths at once.
  Float4 at(Float4 lambda_nm) const {
    constexpr Float4 kOne{1, 1, 1, 1};
    Float4 t = (lambda_nm - 595.f) / 235.f;
    t = t < -kOne ? -kOne : t > kOne ? kOne : t;
    const Float4 x = (c2_ * t + c1_) * t + c0_, size = larger(x, -x), r = square_root(kOne + x * x);
    const Float4 rest = 0.5f / (r * (r + size));
    return x < Float4{} ? rest : kOne - rest;
  }
  /// Largest value over 360 to 830 nm.
  float max_value() const;
  /// Coefficients of t^2, t and 1, rounded to floats.
  Triple coefficients() const { return {double(c2_), double(c1_), double(c0_)}; }

 private:
  /// 1/2 + x / (2 sqrt(1 + x^2)), in a form without cancellation for x < 0.
  static float sigmoid(float x) {
    const float r = std::sqrt(1 + x * x);
    return x < 0 ? 0.5f / (r * (r - x)) : 0.5f + 0.5f * x / r;
  }
  float c2_, c1_, c0_;
};

/// Result of fit_reflectance.
struct SigmoidFit {
  SigmoidPolynomial reflectance;
  double error;  ///< largest difference in X, Y or Z under D65, where white has Y = 1
};

/// Returns the reflectance that has the colour `rgb` (channels in [0, 1]) under D65, by the Levenberg-Marquardt method;
/// this takes some tens of microseconds. No reflectance is as bright and pure as the corners of wide spaces: the result
/// is then the nearest one, and its error is large.
SigmoidFit fit_reflectance(const ColorSpace& space, const Triple& rgb);

/// Fits the coefficients `c` of a SigmoidPolynomial to `rgb`, faster and less exactly than fit_reflectance: nodes are 5
/// nm apart instead of 1. The fit starts at `c`, or if `from_flat` is set at a flat reflectance.
void refine_reflectance(const ColorSpace& space, const Triple& rgb, bool from_flat, Triple& c);

/// Largest error of a fit (SigmoidFit::error, at the colour's full scale) that the functions below accept.
inline constexpr double kLargestFitError = 5e-3;

/// Returns a reflectance of this colour. If no reflectance has it, calls `warn` and returns the nearest one. Throws
/// InputError at `where` unless all channels lie in [0, 1].
SpectrumPtr rgb_albedo(const ColorSpace& space, const Triple& rgb, const Location& where,
                       const std::function<void(const std::string&)>& warn);

/// Multiple of a smooth reflectance.
struct ScaledReflectance {
  SigmoidPolynomial reflectance{{0, 0, 0}};
  double scale = 0;
};

/// Largest difference in X, Y or Z under D65 between a reflectance and the colour `rgb` (SigmoidFit::error).
double reflectance_error(const ColorSpace& space, const Triple& rgb, const SigmoidPolynomial& reflectance);

/// Returns a multiple of a reflectance that has this colour, of any size but black, with an error of at most
/// kLargestFitError of its largest channel. The multiple is twice the largest channel, as in pbrt-v4, or larger: purer
/// colours need narrower and therefore darker reflectances. Throws InputError at `where` if none has this chromaticity.
ScaledReflectance fit_scaled(const ColorSpace& space, const Triple& rgb, const Location& where);

/// Returns a spectrum of any size, such as an index of refraction: a multiple of a reflectance. Throws InputError at
/// `where` if a channel is negative or no reflectance has this chromaticity.
SpectrumPtr rgb_unbounded(const ColorSpace& space, const Triple& rgb, const Location& where);

/// Returns an emission: a multiple of a reflectance times D65 of luminance 1, so that white (1, 1, 1) has Y = 1. Throws
/// InputError at `where` if a channel is negative or no light has this chromaticity.
SpectrumPtr rgb_illuminant(const ColorSpace& space, const Triple& rgb, const Location& where);

}  // namespace frond
