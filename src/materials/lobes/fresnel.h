#pragma once

#include "core/math/float4.h"
#include "core/spectrum.h"

namespace frond {

/// Reflectance of a smooth interface for unpolarised light (Fresnel 1823), given the cosines of incidence and of
/// refraction; `eta`: index of refraction beyond over that on this side.
inline float fresnel_between(float cosine, float beyond, float eta) {
  const float along = (eta * cosine - beyond) / (eta * cosine + beyond);
  const float across = (cosine - eta * beyond) / (cosine + eta * beyond);
  return 0.5f * (along * along + across * across);
}

/// The same given the cosine of incidence alone, >= 0; 1 under total reflection.
inline float fresnel_dielectric(float cosine, float eta) {
  const float sine2 = std::max(0.f, 1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  return fresnel_between(cosine, std::sqrt(1 - sine2), eta);
}

/// The same if the medium beyond absorbs, lane by lane: its index is eta + i k (Born and Wolf, 14.2).
inline SampledSpectrum fresnel_conductor(float cosine, const SampledSpectrum& eta, const SampledSpectrum& k) {
  constexpr float kTiny = 1e-30f;  // avoids 0 / 0 at index 1 and k 0
  const float cosine2 = cosine * cosine, sine2 = std::max(0.f, 1 - cosine2);
  const Float4 eta2 = eta.v * eta.v, k2 = k.v * k.v, difference = eta2 - k2 - sine2;
  const Float4 modulus = square_root(difference * difference + 4 * eta2 * k2);
  const Float4 a = square_root(larger(0.5f * (modulus + difference), Float4{}));
  const Float4 twice = 2 * cosine * a, whole = modulus + cosine2;
  const Float4 across = (whole - twice + kTiny) / (whole + twice + kTiny);
  const Float4 sum = cosine2 * modulus + sine2 * sine2, part = twice * sine2;
  const Float4 along = across * (sum - part + kTiny) / (sum + part + kTiny);
  return SampledSpectrum(larger(0.5f * (across + along), Float4{}));
}

}  // namespace frond
