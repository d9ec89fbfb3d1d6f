#include "core/math/precise_transform.h"

#include <numbers>

namespace frond {
namespace {

using Rows = PreciseTransform::Rows;

constexpr double kFlat = 1e-10;

Rows from_columns(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
  return {{{x.x, y.x, z.x, origin.x}, {x.y, y.y, z.y, origin.y}, {x.z, y.z, z.z, origin.z}}};
}

/// Inverse by cofactors. A matrix whose columns are coplanar up to `flat` counts as singular; the entries of its
/// inverse are NaN.
Rows invert(const Rows& m, double flat) {
  const Vec3d x = column(m, 0), y = column(m, 1), z = column(m, 2), origin = column(m, 3);
  const Vec3d yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double volume = dot(x, yz), box = length(x) * length(y) * length(z);
  const double scale = std::abs(volume) > flat * box ? 1 / volume : NAN;
  const Vec3d a = yz * scale, b = zx * scale, c = xy * scale;
  return {{{a.x, a.y, a.z, -dot(a, origin)}, {b.x, b.y, b.z, -dot(b, origin)}, {c.x, c.y, c.z, -dot(c, origin)}}};
}

}  // namespace

Transform::RowsDouble to_double(const Transform::Rows& m) {
  Transform::RowsDouble rows;
  for (size_t i = 0; i < 3; ++i) std::copy(m[i].begin(), m[i].end(), rows[i].begin());
  return rows;
}

Transform::RowsDouble multiply(const Transform::RowsDouble& a, const Transform::RowsDouble& b) {
  Transform::RowsDouble product;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + (j == 3 ? a[i][3] : 0);
  return product;
}

/// The limit is the rounding of decimals in a scene file.
PreciseTransform::PreciseTransform(const Rows& rows) : rows_(rows), inverse_(invert(rows, kFlat)) {}

PreciseTransform::PreciseTransform(const Transform& t) : rows_(to_double(t.rows())), inverse_(invert(rows_, 0)) {}

PreciseTransform PreciseTransform::translate(const Vec3d& by) {
  return {from_columns({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by), from_columns({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, -by)};
}

PreciseTransform PreciseTransform::scale(const Vec3d& by) {
  return PreciseTransform(from_columns({by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}));
}

/// Rodrigues' rotation formula (1840).
PreciseTransform PreciseTransform::rotate(double angle_deg, const Vec3d& axis) {
  const double angle = angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3d a = normalize(axis);
  const auto turned = [&](const Vec3d& e) { return e * c + cross(a, e) * s + a * (dot(a, e) * (1 - c)); };
  return PreciseTransform(from_columns(turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}));
}

PreciseTransform PreciseTransform::look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d forward = normalize(target - eye);
  const Vec3d right = normalize(cross(normalize(up), forward));
  return PreciseTransform(from_columns(right, cross(forward, right), forward, eye)).inverse();
}

PreciseTransform operator*(const PreciseTransform& a, const PreciseTransform& b) {
  return {multiply(a.rows_, b.rows_), multiply(b.inverse_, a.inverse_)};
}

}  // namespace frond
