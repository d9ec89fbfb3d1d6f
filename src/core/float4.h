#pragma once

#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace frond {

/// Four floats in one register, by the compilers' own vector type: for the few loops that are worth it. + - * / and
/// comparisons are the language's.
using Float4 = float __attribute__((vector_size(16)));

/// Four doubles, in as many registers as they take.
using Double4 = double __attribute__((vector_size(32)));

inline Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
inline float sum(Float4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// In all lanes.
inline bool are_equal(Float4 a, Float4 b) {
#if defined(__SSE2__)
  return _mm_movemask_ps(_mm_cmpneq_ps(a, b)) == 0;
#else
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
#endif
}

inline Float4 square_root(Float4 x) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  for (int i = 0; i < 4; ++i) x[i] = std::sqrt(x[i]);
  return x;
#endif
}

}  // namespace frond
