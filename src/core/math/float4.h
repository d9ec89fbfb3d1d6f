#pragma once

#include <cmath>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace frond {

/// Four floats in one SIMD register (vector extension of GCC and Clang). + - * / and comparisons are built in and work
/// lane by lane.
using Float4 = float __attribute__((vector_size(16)));

/// Four doubles, in one or two SIMD registers.
using Double4 = double __attribute__((vector_size(32)));

/// Lane-wise maximum.
inline Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
/// Sum of the four lanes.
inline float sum(Float4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// True if a and b are equal in all lanes.
inline bool are_equal(Float4 a, Float4 b) {
#if defined(__SSE2__)
  return _mm_movemask_ps(_mm_cmpneq_ps(a, b)) == 0;
#else
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
#endif
}

/// True if all lanes are finite and not negative.
inline bool are_finite_and_not_negative(Float4 x) {
  const auto valid = (x >= 0.f) & (x <= std::numeric_limits<float>::max());
#if defined(__SSE2__)
  return _mm_movemask_ps(Float4(valid)) == 0b1111;
#else
  return (valid[0] & valid[1] & valid[2] & valid[3]) != 0;
#endif
}

/// Lane-wise square root.
inline Float4 square_root(Float4 x) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  for (int i = 0; i < 4; ++i) x[i] = std::sqrt(x[i]);
  return x;
#endif
}

}  // namespace frond
