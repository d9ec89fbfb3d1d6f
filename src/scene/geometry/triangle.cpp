#include "scene/geometry/triangle.h"

namespace frond {

/// Computed in double precision, because texture coordinates may be nearly degenerate.
SurfaceDerivatives Triangle::derivatives() const {
  const Vec3 &p0 = mesh_.p[index_[0]], e1 = mesh_.p[index_[1]] - p0, e2 = mesh_.p[index_[2]] - p0;
  auto [s, t] = default_sides();
  if (!mesh_.uv.empty()) s = mesh_.uv[index_[1]] - mesh_.uv[index_[0]], t = mesh_.uv[index_[2]] - mesh_.uv[index_[0]];
  const double det = double(s.x) * double(t.y) - double(s.y) * double(t.x);
  const auto along = [det](const Vec3& a, const Vec3& b, float x, float y) {
    return to_float((to_double(a) * double(x) + to_double(b) * double(y)) / det);
  };
  SurfaceDerivatives d;
  if (det != 0) d.dpdu = along(e1, e2, t.y, -s.y), d.dpdv = along(e1, e2, -t.x, s.x);
  if (!(dot(cross(d.dpdu, d.dpdv), cross(d.dpdu, d.dpdv)) > 0)) {
    const Vec3 n = normalize_any(ng());
    const Frame frame = Frame::around(n == Vec3{} ? Vec3{0, 0, 1} : n);
    return {frame.x, frame.y, {}, {}};
  }
  if (mesh_.n.empty()) return d;
  const Vec3 n = ns(), &n0 = mesh_.n[index_[0]], d1 = mesh_.n[index_[1]] - n0, d2 = mesh_.n[index_[2]] - n0;
  const float size = length(n);
  if (!(size > 0)) return d;
  // Derivative of the normalized normal: its component along the normal is removed.
  const auto across = [&](const Vec3& dn) { return (dn - n * (dot(n, dn) / (size * size))) / size; };
  d.dndu = across(along(d1, d2, t.y, -s.y)), d.dndv = across(along(d1, d2, -t.x, s.x));
  return d;
}

}  // namespace frond
