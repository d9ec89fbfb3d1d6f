#include "core/math/motion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace frond {
namespace {

Eigen::Matrix3d linear_of(const AffineMap& map) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = double(map.rows[size_t(i)][size_t(j)]);
  return m;
}

Vec3 lerp(float s, const Vec3& a, const Vec3& b) { return a * (1 - s) + b * s; }

}  // namespace

/// A mirroring map's rotation is proper: what is left mirrors. (pbrt-v4 makes a quaternion of the improper one.)
Motion::Motion(const AffineMap& start, const AffineMap& end, Interval seen)
    : seen_(seen), translation_{start.translation(), end.translation()} {
  std::array<Eigen::Quaterniond, 2> turn;
  for (size_t k = 0; k < 2; ++k) {
    Eigen::Matrix3d rotation, rest;
    Eigen::Affine3d(linear_of(k == 0 ? start : end)).computeRotationScaling(&rotation, &rest);
    turn[k] = Eigen::Quaterniond(rotation).normalized();
    for (int i = 0; i < 3; ++i) stretch_[k][size_t(i)] = {float(rest(i, 0)), float(rest(i, 1)), float(rest(i, 2))};
  }
  if (turn[0].dot(turn[1]) < 0) turn[1].coeffs() *= -1;  // the shorter way
  angle_ =
      float(2 * std::atan2((turn[0].coeffs() - turn[1].coeffs()).norm(), (turn[0].coeffs() + turn[1].coeffs()).norm()));
  constexpr float kTurned = 1e-6f;  // below, rounding turned it
  if (angle_ < kTurned) angle_ = 0;
  const Eigen::Vector4d from = turn[0].coeffs(), across = turn[1].coeffs() - from * from.dot(turn[1].coeffs());
  for (int i = 0; i < 4; ++i) {
    rotation_[0][size_t(i)] = float(from[i]);
    if (angle_ > 0) rotation_[1][size_t(i)] = float(across[i] / across.norm());
  }
}

float Motion::share(float time) const {
  const float s = float(seen_.min + double(time) * (seen_.max - seen_.min));
  return std::clamp(s, 0.f, 1.f);
}

AffineMap Motion::at(float time) const {
  const float s = share(time);
  const float a = std::cos(s * angle_), b = std::sin(s * angle_);
  const auto& [q, r] = rotation_;
  const float x = a * q[0] + b * r[0], y = a * q[1] + b * r[1], z = a * q[2] + b * r[2], w = a * q[3] + b * r[3];
  const std::array<Vec3, 3> turn{Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                 Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                 Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  const Stretch rest{lerp(s, stretch_[0][0], stretch_[1][0]), lerp(s, stretch_[0][1], stretch_[1][1]),
                     lerp(s, stretch_[0][2], stretch_[1][2])};
  const Vec3 t = lerp(s, translation_[0], translation_[1]);
  AffineMap map;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 row = rest[0] * turn[i].x + rest[1] * turn[i].y + rest[2] * turn[i].z;
    map.rows[i] = {row.x, row.y, row.z, t[int(i)]};
  }
  return map;
}

bool Motion::is_still() const { return share(0) == share(1); }

bool Motion::has_corner() const {
  const auto is_outside = [](double s) { return s < 0 || s > 1; };
  return !is_still() && (is_outside(seen_.min) || is_outside(seen_.max));
}

/// One part for each 11 degrees of rotation; a motion along chords needs one.
unsigned Motion::parts() const {
  if (has_corner()) return kMostParts;
  const double turned = 2 * double(angle_) * (seen_.max - seen_.min);
  return std::clamp(unsigned(std::ceil(turned / (std::numbers::pi / 16))), 1u, kMostParts);
}

/// With p(s) = t(s) + R(s) S(s) x, |p''| is at most (w^2 |S| + 2 w |S'|) |x| for a rotation by the angle w; a curve is
/// within h^2 / 8 |p''| of its chord over a step h. A corner adds at most h / 4 of the speed.
float Motion::deviation(unsigned parts, float size) const {
  const auto norm = [](const Stretch& m) { return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2])); };
  const auto& [a, b] = stretch_;
  const float stretch = std::max(norm(a), norm(b)) * size,
              change = norm({b[0] - a[0], b[1] - a[1], b[2] - a[2]}) * size;
  const float turn = 2 * angle_, h = float(seen_.max - seen_.min) / float(parts);
  float bound = h * h / 8 * (turn * turn * stretch + 2 * turn * change);
  if (has_corner()) bound += h / 4 * (length(translation_[1] - translation_[0]) + turn * stretch + change);
  return bound;
}

std::string problem_of_motion(const AffineMap& start, const AffineMap& end) {
  if ((linear_of(start).determinant() < 0) != (linear_of(end).determinant() < 0))
    return "it begins as a mirror image of its end: on the way it would be flat";
  return {};
}

void CameraMotion::move(Ray& ray) const {
  const Float4 point = from_start_.point(Float4{ray.o.x, ray.o.y, ray.o.z, 0});
  const Float4 vector = from_start_.vector(Float4{ray.d.x, ray.d.y, ray.d.z, 0});
  const AffineMap now = motion_.at(ray.time);
  ray.o = now.point({point[0], point[1], point[2]});
  ray.d = normalize_any(now.vector({vector[0], vector[1], vector[2]}));
}

}  // namespace frond
