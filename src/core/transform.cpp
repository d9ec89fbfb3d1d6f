#include "core/transform.h"

#include <algorithm>
#include <numbers>

namespace frond {
namespace {

using RowsDouble = Transform::RowsDouble;

Vec3d column(const RowsDouble& m, size_t j) { return {m[0][j], m[1][j], m[2][j]}; }

RowsDouble from_columns(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
  return {{{x.x, y.x, z.x, origin.x}, {x.y, y.y, z.y, origin.y}, {x.z, y.z, z.z, origin.z}}};
}

Transform::Rows to_float(const RowsDouble& m) {
  Transform::Rows rows;
  for (size_t i = 0; i < 3; ++i)
    std::transform(m[i].begin(), m[i].end(), rows[i].begin(), [](double v) { return static_cast<float>(v); });
  return rows;
}

RowsDouble to_double(const Transform::Rows& m) {
  RowsDouble rows;
  for (size_t i = 0; i < 3; ++i) std::copy(m[i].begin(), m[i].end(), rows[i].begin());
  return rows;
}

Transform::Rows multiply(const Transform::Rows& a, const Transform::Rows& b) {
  const RowsDouble p = to_double(a), q = to_double(b);
  RowsDouble product;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      product[i][j] = p[i][0] * q[0][j] + p[i][1] * q[1][j] + p[i][2] * q[2][j] + (j == 3 ? p[i][3] : 0);
  return to_float(product);
}

/// Inverse by cofactors. A matrix whose columns are coplanar up to the rounding of decimals in a scene file counts as
/// singular; the entries of its inverse are NaN.
RowsDouble invert(const RowsDouble& m) {
  constexpr double kFlat = 1e-10;
  const Vec3d x = column(m, 0), y = column(m, 1), z = column(m, 2), origin = column(m, 3);
  const Vec3d yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double volume = dot(x, yz), box = length(x) * length(y) * length(z);
  const double scale = std::abs(volume) > kFlat * box ? 1 / volume : NAN;
  const Vec3d a = yz * scale, b = zx * scale, c = xy * scale;
  return {{{a.x, a.y, a.z, -dot(a, origin)}, {b.x, b.y, b.z, -dot(b, origin)}, {c.x, c.y, c.z, -dot(c, origin)}}};
}

bool is_finite(const Transform::Rows& m) {
  return std::all_of(m.begin(), m.end(), [](const auto& row) {
    return std::all_of(row.begin(), row.end(), [](float v) { return std::isfinite(v); });
  });
}

}  // namespace

Transform::Transform(const RowsDouble& rows) : rows_(to_float(rows)), inverse_(to_float(invert(rows))) {}

Transform Transform::translate(const Vec3& by) {
  Transform t;
  for (int i = 0; i < 3; ++i) {
    t.rows_[static_cast<size_t>(i)][3] = by[i];
    t.inverse_[static_cast<size_t>(i)][3] = -by[i];
  }
  return t;
}

Transform Transform::scale(const Vec3& by) {
  return Transform(from_columns({by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}));
}

/// Rodrigues' rotation formula (1840).
Transform Transform::rotate(double angle_deg, const Vec3& axis) {
  const double angle = angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3d a = normalize(to_double(axis));
  const auto turned = [&](const Vec3d& e) { return e * c + cross(a, e) * s + a * (dot(a, e) * (1 - c)); };
  return Transform(from_columns(turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}));
}

Transform Transform::look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
  const Vec3d forward = normalize(to_double(target) - to_double(eye));
  const Vec3d right = normalize(cross(normalize(to_double(up)), forward));
  return Transform(from_columns(right, cross(forward, right), forward, to_double(eye))).inverse();
}

Transform operator*(const Transform& a, const Transform& b) {
  return {multiply(a.rows_, b.rows_), multiply(b.inverse_, a.inverse_)};
}

bool Transform::is_valid() const { return is_finite(rows_) && is_finite(inverse_); }

bool Transform::swaps_handedness() const {
  const RowsDouble m = to_double(rows_);
  return dot(column(m, 0), cross(column(m, 1), column(m, 2))) < 0;
}

}  // namespace frond
