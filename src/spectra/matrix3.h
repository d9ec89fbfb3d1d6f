#pragma once

#include <array>

namespace frond {

/// The three values of a colour: XYZ or RGB.
using Triple = std::array<double, 3>;

/// 3x3 matrix, stored by rows, that multiplies column vectors.
struct Matrix3 {
  std::array<Triple, 3> row{};

  static constexpr Matrix3 diagonal(const Triple& d) { return {{{{d[0], 0, 0}, {0, d[1], 0}, {0, 0, d[2]}}}}; }

  friend constexpr Triple operator*(const Matrix3& m, const Triple& v) {
    Triple r{};
    for (size_t i = 0; i < 3; ++i) r[i] = m.row[i][0] * v[0] + m.row[i][1] * v[1] + m.row[i][2] * v[2];
    return r;
  }
  friend constexpr Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    Matrix3 r;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j)
        r.row[i][j] = a.row[i][0] * b.row[0][j] + a.row[i][1] * b.row[1][j] + a.row[i][2] * b.row[2][j];
    return r;
  }
};

/// Returns the inverse by cofactors; the determinant must not be 0 (not checked).
constexpr Matrix3 inverse(const Matrix3& m) {
  const auto cofactor = [&m](size_t i, size_t j) {
    const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return m.row[i1][j1] * m.row[i2][j2] - m.row[i1][j2] * m.row[i2][j1];
  };
  const double det = m.row[0][0] * cofactor(0, 0) + m.row[0][1] * cofactor(0, 1) + m.row[0][2] * cofactor(0, 2);
  Matrix3 r;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) r.row[i][j] = cofactor(j, i) / det;
  return r;
}

}  // namespace frond
