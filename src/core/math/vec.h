#pragma once

#include <algorithm>
#include <cmath>

namespace frond {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr double kPiD = 3.14159265358979323846, kDegree = kPiD / 180;  ///< a degree in radians
inline constexpr float kInvPi = 0.31830988618379067154f;

/// Three components: a point, a vector or a normal. The renderer uses `float`, the random walk in leaves `double`.
template <class T>
struct Vec3T {
  T x{}, y{}, z{};

  constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3T operator-() const { return {-x, -y, -z}; }
  constexpr Vec3T& operator+=(const Vec3T& b) { return *this = *this + b; }
  constexpr Vec3T& operator*=(T s) { return *this = *this * s; }
  friend constexpr Vec3T operator+(const Vec3T& a, const Vec3T& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3T operator-(const Vec3T& a, const Vec3T& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3T operator*(const Vec3T& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3T operator*(T s, const Vec3T& a) { return a * s; }
  friend constexpr Vec3T operator/(const Vec3T& a, T s) { return a * (T(1) / s); }
  friend constexpr bool operator==(const Vec3T&, const Vec3T&) = default;
};

using Vec3 = Vec3T<float>;
using Vec3d = Vec3T<double>;

constexpr Vec3d to_double(const Vec3& v) { return {double(v.x), double(v.y), double(v.z)}; }
constexpr Vec3 to_float(const Vec3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// Two components: texture coordinates, film positions or a pair of random numbers.
struct Vec2 {
  float x{}, y{};
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }
  friend constexpr bool operator==(Vec2, Vec2) = default;
};

template <class T>
constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(const Vec3T<T>& a) {
  return std::sqrt(dot(a, a));
}
/// `a` scaled to length 1. The square of its length must neither overflow nor underflow.
template <class T>
Vec3T<T> normalize(const Vec3T<T>& a) {
  return a / length(a);
}
/// `a` scaled to length 1 after division by its largest component; 0 if `a` is 0. Slow path of normalize_any.
template <class T>
[[gnu::cold, gnu::noinline]] Vec3T<T> normalize_extreme(const Vec3T<T>& a) {
  const T largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  if (!(largest > 0)) return {};
  return normalize(Vec3T<T>{a.x / largest, a.y / largest, a.z / largest});
}
/// `a` scaled to length 1, also if the square of its length overflows or underflows; 0 if `a` is 0.
template <class T>
inline Vec3T<T> normalize_any(const Vec3T<T>& a) {
  const T square = dot(a, a);
  return square > T(1e-30) && square < T(1e30) ? a / std::sqrt(square) : normalize_extreme(a);
}

/// Right-handed orthonormal frame with unit axes x, y and z.
template <class T>
struct FrameT {
  Vec3T<T> x, y, z;

  /// Frame with z = `n`, a unit vector. Duff et al. 2017, Building an Orthonormal Basis, Revisited (JCGT 6(1)): free of
  /// branches, and accurate near both poles.
  static FrameT around(const Vec3T<T>& n) {
    const T sign = std::copysign(T(1), n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  /// Frame with z = `n`, a unit vector, and x along the projection of `v` onto the plane normal to `n`; x is arbitrary
  /// if `v` is parallel to `n`.
  static FrameT along(const Vec3T<T>& n, const Vec3T<T>& v) {
    const Vec3T<T> y = normalize_any(cross(n, v));
    return dot(y, y) > T(0.5) ? FrameT{cross(y, n), y, n} : around(n);
  }
  Vec3T<T> to_local(const Vec3T<T>& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3T<T> to_world(const Vec3T<T>& v) const { return x * v.x + y * v.y + z * v.z; }
};

using Frame = FrameT<float>;
using Framed = FrameT<double>;

}  // namespace frond
