#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// SIMD registers of floats and integers as the compilers' vector types, as wide as the including file is compiled for.
/// Only + - * / and square roots are used, which IEEE 754 rounds in one way, so that every width gives the same bits.
/// The namespace is unnamed because each including file requires functions of its own, for its own instructions.
namespace frond::leaf::batch {
namespace {

#if defined(__AVX512F__)
constexpr size_t kLanes = 16;
#elif defined(__AVX2__)
constexpr size_t kLanes = 8;
#else
constexpr size_t kLanes = 4;
#endif

typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef int32_t Ints __attribute__((vector_size(4 * kLanes)));  // masks too: -1 for true
typedef uint32_t Bits __attribute__((vector_size(4 * kLanes)));

/// Aligned loads and stores of columns of Slots.
template <class Register, class T>
Register load(const T* from) {
  Register value;
  __builtin_memcpy(&value, __builtin_assume_aligned(from, sizeof(Register)), sizeof(Register));
  return value;
}
template <class Register, class T>
void store(T* to, Register value) {
  __builtin_memcpy(__builtin_assume_aligned(to, sizeof(Register)), &value, sizeof(Register));
}

inline Floats broadcast(float x) { return Floats{} + x; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }
inline Floats to_floats(Ints i) { return __builtin_convertvector(i, Floats); }

inline Floats square_root(Floats x) {
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_ps(0xffff, x);  // the plain one makes g++ 12 warn of its own header
#elif defined(__AVX2__)
  return _mm256_sqrt_ps(x);
#elif defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  for (size_t i = 0; i < kLanes; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
#endif
}

/// Returns table[index] of a table of sixteen, lane by lane.
inline Floats gather(const float* table, Ints index) {
#if defined(__AVX512F__)
  return _mm512_maskz_permutexvar_ps(0xffff, reinterpret_cast<__m512i>(index), _mm512_load_ps(table));
#elif defined(__AVX2__)
  const Floats low = _mm256_permutevar8x32_ps(_mm256_load_ps(table), reinterpret_cast<__m256i>(index));
  const Floats high = _mm256_permutevar8x32_ps(_mm256_load_ps(table + 8), reinterpret_cast<__m256i>(index));
  return index < 8 ? low : high;
#else
  Floats result{};
  for (size_t i = 0; i < kLanes; ++i) result[i] = table[index[i]];
  return result;
#endif
}

/// Returns the mask as bits: bit i is lane i.
inline uint64_t to_bitmask(Ints mask) {
#if defined(__AVX512F__)
  return _mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(mask), _mm512_setzero_si512());
#elif defined(__AVX2__)
  return static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(__SSE2__)
  return static_cast<uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  uint64_t result = 0;
  for (size_t i = 0; i < kLanes; ++i) result |= uint64_t{mask[i] != 0} << i;
  return result;
#endif
}

// Polynomials by interpolation at Chebyshev's nodes; relative errors below 3e-7.

template <size_t kTerms>
Floats polynomial(const float (&coefficients)[kTerms], Floats x) {
  Floats sum = broadcast(coefficients[kTerms - 1]);
  for (size_t i = kTerms - 1; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

/// log2 x for x > 0, normal.
inline Floats log2_of(Floats x) {
  constexpr int32_t kRootHalf = 0x3f3504f3;
  constexpr float kTerms[] = {1.44269502f,  -0.721352935f, 0.480916709f, -0.360225171f,
                              0.287288874f, -0.249271825f, 0.232652575f, -0.14275974f};
  const Ints bits = reinterpret_cast<Ints>(x) - kRootHalf;
  const Floats t = reinterpret_cast<Floats>((bits & 0x7fffff) + kRootHalf) - 1.f;
  return to_floats(bits >> 23) + t * polynomial(kTerms, t);
}

/// 2^x for x <= 0; exactly 1 at 0, and 0 below -126.
inline Floats exp2_of(Floats x) {
  constexpr float kRounder = 12582912;  // 1.5 * 2^23: adding it rounds to a whole number, found in the lowest bits
  constexpr float kTerms[] = {1, 0.693147182f, 0.240221068f, 0.0555035695f, 0.00967603177f, 0.00133908633f};
  const Floats within = larger(x, broadcast(-126)), shifted = within + kRounder;
  const Ints power = reinterpret_cast<Ints>(shifted) << 23;
  const Ints scaled = reinterpret_cast<Ints>(polynomial(kTerms, within - (shifted - kRounder))) + power;
  return x < -126.f ? broadcast(0) : reinterpret_cast<Floats>(scaled);
}

/// cos x for x in [0, 1], radians.
inline Floats cos_of(Floats x) {
  constexpr float kTerms[] = {1, -0.49999997f, 0.0416664556f, -0.00138829579f, 2.41210728e-05f};
  return polynomial(kTerms, x * x);
}

struct CirclePoint {
  Floats cosine, sine;
};

/// Returns a uniform point of the unit circle from 32 random bits.
inline CirclePoint circle_point(Bits bits) {
  // 31 bits are half an angle, in units of 45 degrees: between them they make half a circle. One bit chooses the half.
  constexpr float kSine[] = {0.785398185f, -0.0807454363f, 0.00249000685f, -3.59542901e-05f};
  constexpr float kCosine[] = {1, -0.308424264f, 0.0158499107f, -0.000318877486f};
  const Floats half = to_floats(reinterpret_cast<Ints>(bits << 1)) * 0x1p-31f, square = half * half;
  const Floats s = half * polynomial(kSine, square), c = polynomial(kCosine, square);
  const Floats cosine = 1.f - 2.f * s * s;
  return {reinterpret_cast<Floats>(reinterpret_cast<Bits>(cosine) ^ (bits & 0x80000000u)), 2.f * s * c};
}

/// sfc32 (Doty-Humphrey, PractRand): 32 bits a draw, a period of at least 2^32 draws.
struct Generators {
  Bits a, b, c, counter;

  Bits bits() {
    const Bits result = a + b + counter;
    counter += 1u;
    a = b ^ (b >> 9);
    b = c + (c << 3);
    c = ((c << 21) | (c >> 11)) + result;
    return result;
  }
  /// In [0, 1), 24 bits.
  Floats uniform() { return to_floats(reinterpret_cast<Ints>(bits() >> 8)) * 0x1p-24f; }
  /// -log2 of a uniform number in (0, 1], which has 31 bits and is rounded to a float.
  Floats exponential() { return -log2_of((to_floats(reinterpret_cast<Ints>(bits() >> 1)) + 0.5f) * 0x1p-31f); }
};

}  // namespace
}  // namespace frond::leaf::batch
