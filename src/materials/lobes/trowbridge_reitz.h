#pragma once

#include "core/math/sampling.h"
#include "core/math/vec.h"

namespace frond {

/// Distribution of facet normals of a rough surface (Trowbridge and Reitz 1975; "GGX") with slope widths alpha along x
/// and y, and Smith's shadowing, height correlated (Heitz 2014). Directions lie on the side of +z.
class TrowbridgeReitz {
 public:
  /// Smooth if both widths are below `kSmooth`; else each is at least kSmooth and a thousandth of the other.
  TrowbridgeReitz(float alpha_x, float alpha_y) {
    const float larger = std::min(std::max(alpha_x, alpha_y), kRoughest);
    const float least = larger < kSmooth ? 0 : std::max(kSmooth, 1e-3f * larger);
    x_ = std::clamp(alpha_x, least, kRoughest);
    y_ = std::clamp(alpha_y, least, kRoughest);
  }

  /// Facets for paths that scattered widely before, as in pbrt-v4: widths below 0.3 are doubled, to 0.1 at least and
  /// 0.3 at most.
  TrowbridgeReitz regularized() const {
    const auto widened = [](float alpha) { return alpha < 0.3f ? std::clamp(2 * alpha, 0.1f, 0.3f) : alpha; };
    return {widened(x_), widened(y_)};
  }

  bool is_smooth() const { return std::max(x_, y_) < kSmooth; }
  Vec2 alpha() const { return {x_, y_}; }

  /// D(m): area density of facets of this normal, relative to the surface's area, 1/sr.
  float density(const Vec3& m) const {
    if (m.z <= 0) return 0;
    const float x = m.x / x_, y = m.y / y_, square = x * x + y * y + m.z * m.z;
    return kInvPi / (x_ * y_ * square * square);
  }
  /// Length of the stretched direction: cos theta (1 + 2 Lambda) of Smith's function.
  float stretch(const Vec3& w) const {
    const float x = x_ * w.x, y = y_ * w.y;
    return std::sqrt(w.z * w.z + x * x + y * y);
  }
  /// G2 / (4 cos theta_a cos theta_b): share of facets visible from both.
  float smith_visibility(const Vec3& a, const Vec3& b) const { return 0.5f / (a.z * stretch(b) + b.z * stretch(a)); }
  /// Density of `sample_visible`, divided by `density` and |dot(w, m)|.
  float g1_over_cosine(const Vec3& w) const { return 2 / (w.z + stretch(w)); }

  /// Draws a normal in proportion to its facets' visibility from `w` (Heitz 2018), by spherical caps (Dupuy and Benyoub
  /// 2023).
  Vec3 sample_visible(const Vec3& w, Vec2 u) const {
    const Vec3 stretched = normalize_any(Vec3{x_ * w.x, y_ * w.y, w.z});
    const float phi = 2 * kPi * u.x, z = 1 - u.y * (1 + stretched.z);
    const float sine = std::sqrt(std::max(0.f, 1 - z * z));
    const Vec3 h = stretched + Vec3{sine * std::cos(phi), sine * std::sin(phi), z};
    return normalize_any(Vec3{x_ * h.x, y_ * h.y, std::max(h.z, 1e-7f)});
  }

 private:
  static constexpr float kSmooth = 1e-3f, kRoughest = 10;

  float x_, y_;
};

}  // namespace frond
