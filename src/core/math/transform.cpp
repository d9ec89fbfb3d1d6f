#include "core/math/transform.h"

#include <algorithm>

#include "core/math/precise_transform.h"

namespace frond {
namespace {

using RowsDouble = Transform::RowsDouble;

Transform::Rows to_float(const RowsDouble& m) {
  Transform::Rows rows;
  for (size_t i = 0; i < 3; ++i)
    std::transform(m[i].begin(), m[i].end(), rows[i].begin(), [](double v) { return static_cast<float>(v); });
  return rows;
}

Transform::Rows product_of(const Transform::Rows& a, const Transform::Rows& b) {
  return to_float(multiply(to_double(a), to_double(b)));
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
  return {product_of(a.rows_, b.rows_), product_of(b.inverse_, a.inverse_)};
}

bool Transform::is_valid() const { return is_finite(rows_) && is_finite(inverse_); }

bool Transform::swaps_handedness() const {
  const RowsDouble m = to_double(rows_);
  return dot(column(m, 0), cross(column(m, 1), column(m, 2))) < 0;
}

}  // namespace frond
