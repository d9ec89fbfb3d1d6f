#pragma once

#include <bit>
#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "core/spectrum.h"

namespace frond {

/// Four floats in one register, by the compilers' own vector type: for the few loops that are worth it. + - * / and
/// comparisons are the language's.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 to_float4(const SampledSpectrum& s) { return std::bit_cast<Float4>(s); }
inline SampledSpectrum to_spectrum(Float4 x) { return std::bit_cast<SampledSpectrum>(x); }

inline Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
inline float sum(Float4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

inline Float4 square_root(Float4 x) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  for (int i = 0; i < 4; ++i) x[i] = std::sqrt(x[i]);
  return x;
#endif
}

}  // namespace frond
