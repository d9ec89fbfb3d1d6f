#pragma once

#include "media/tracking.h"

namespace frond {

/// A path with the densities of its vertices, for single-sample multiple importance sampling over wavelengths (Miller
/// et al. 2019, "A null-scattering path integral formulation of light transport"; pbrt 4th ed., 14.2.2). Distances in
/// media are sampled for one lane, the hero, which is drawn uniformly for each path, so that the density of the whole
/// is the mean over lanes. All members are relative to the density of the hero's sampling.
struct SpectralPath {
  SampledSpectrum beta;  ///< throughput
  SampledSpectrum r_u;   ///< density of the same path if lane i were the hero
  SampledSpectrum r_l;   ///< the same, without the density of the last direction: that of a light sample is a factor
  int hero = 0;

  void multiply(const SampledSpectrum& b, const SampledSpectrum& u, const SampledSpectrum& l) {
    beta *= b, r_u *= u, r_l *= l;
  }
};

inline SampledSpectrum null_coefficient(const SampledSpectrum& majorant, const MediumPoint& at) {
  return SampledSpectrum(larger(majorant.v - at.sigma_a.v - at.sigma_s.v, Float4{}));
}

}  // namespace frond
