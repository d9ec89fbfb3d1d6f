#include "core/math/transform.h"

#include <algorithm>

#include "core/math/precise_transform.h"

namespace frond {
namespace {

using RowsDouble = Transform::RowsDouble;

Vec3d column(const RowsDouble& m, size_t j) { return {m[0][j], m[1][j], m[2][j]}; }

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

bool is_finite(const Transform::Rows& m) {
  return std::all_of(m.begin(), m.end(), [](const auto& row) {
    return std::all_of(row.begin(), row.end(), [](float v) { return std::isfinite(v); });
  });
}

}  // namespace

Transform::Transform(const RowsDouble& rows)
    : rows_(to_float(rows)), inverse_(to_float(PreciseTransform(rows).inverse().rows())) {}

Transform Transform::translate(const Vec3& by) {
  Transform t;
  for (int i = 0; i < 3; ++i) {
    t.rows_[static_cast<size_t>(i)][3] = by[i];
    t.inverse_[static_cast<size_t>(i)][3] = -by[i];
  }
  return t;
}

Transform Transform::scale(const Vec3& by) { return PreciseTransform::scale(to_double(by)).rounded(); }

Transform Transform::rotate(double angle_deg, const Vec3& axis) {
  return PreciseTransform::rotate(angle_deg, to_double(axis)).rounded();
}

Transform Transform::look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
  return PreciseTransform::look_at(to_double(eye), to_double(target), to_double(up)).inverse().rounded().inverse();
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
