#pragma once

#include <array>
#include <span>
#include <vector>

#include "leaf/solve/quadrature.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

class LobeMeans;

/// Reflectance and transmittance of a leaf of one structure as a function of wavelength and optical depth, through
/// which alone the leaf's chemistry acts. The interpolation is within 3e-4 of the walk solved with the same nodes (4e-3
/// where the cuticle's index is near the mesophyll's). For searches, whose last steps solve the walk itself.
///
/// Surfaces of one kind of leaf are added like vectors: to first order a surface of another structure is this one plus
/// the differences that the structure's numbers make.
class OpticsSurface {
 public:
  static constexpr size_t kWavelengths = 5, kTerms = 12;

  /// Weights of the solved wavelengths in the interpolation to another one.
  using Weights = std::array<double, kWavelengths>;
  /// Returns the weights for a wavelength within kConstantsRange_nm. At a given depth R and T depend on the wavelength
  /// through the refractive indices alone, in which they are interpolated.
  static Weights weights(double lambda_nm);

  /// Polynomials of depth, and their derivatives with respect to the depth.
  struct Terms {
    std::array<double, kTerms> value, slope;
  };
  /// `depth`: optical depth of the mesophyll along the leaf's normal, at least 0. Beyond 40, where a leaf is opaque,
  /// the value of 40 is used.
  static Terms terms(double depth);

  OpticsSurface() = default;  ///< of no leaf, to be replaced
  /// Uses the structure, the aspect ratios of the walls, the cuticle and the sieve effect of `params`. Angles of
  /// incidence as in `solve`, degrees in [0, 180]. `means`: lobe_mean.h.
  OpticsSurface(const TissueParams& params, std::span<const double> theta_deg, const NodeRule& rule, LobeMeans& means);

  /// Adds `factor` times the other surface, of as many angles.
  void add(double factor, const OpticsSurface& other);

  void scale(double factor);

  /// R and T, or their derivatives.
  struct Pair {
    double r = 0, t = 0;
  };
  /// Returns the sum of the polynomials `terms` (values or slopes) at one angle, an index of the constructor's.
  Pair sum(size_t angle, const Weights& weights, const std::array<double, kTerms>& terms) const {
    Pair result;
    for (size_t w = 0; w < kWavelengths; ++w) {
      const std::array<Pair, kTerms>& part = series_[angle * kWavelengths + w];
      double r = 0, t = 0;
      for (size_t k = 0; k < kTerms; ++k) r += part[k].r * terms[k], t += part[k].t * terms[k];
      result.r += weights[w] * r, result.t += weights[w] * t;
    }
    return result;
  }

 private:
  std::vector<std::array<Pair, kTerms>> series_;  ///< Chebyshev coefficients, [angle][wavelength]
};

}  // namespace frond::leaf
