#include "shapes/bilinear.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/shape.h"

namespace frond {
namespace {

/// A patch with corners at (u, v) = (0,0), (1,0), (0,1), (1,1).
struct Patch {
  std::array<Vec3d, 4> p;

  /// Point of the surface (pbrt 4th ed., 6.6).
  Vec3d at(double u, double v) const { return along_u(u, 0) * (1 - v) + along_u(u, 2) * v; }
  /// Partial derivative by u, which depends on v alone; dv depends on u alone.
  Vec3d du(double v) const { return (p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v; }
  Vec3d dv(double u) const { return (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u; }
  /// Not normalized: its length is the area element for each du dv.
  Vec3d normal(double u, double v) const { return cross(du(v), dv(u)); }

 private:
  Vec3d along_u(double u, size_t first) const { return p[first] * (1 - u) + p[first + 1] * u; }
};

/// Returns the real roots of a + b x + c x^2, without cancellation; -1, which is outside of a patch, where there is
/// none.
std::array<double, 2> quadratic_roots(double a, double b, double c) {
  constexpr double kNone = -1;
  if (c == 0) return {b != 0 ? -a / b : kNone, kNone};
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return {kNone, kNone};
  // The sum has no cancellation, because both terms have the same sign; the other root follows from the product of the
  // roots, a / c.
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  return {q / c, q != 0 ? a / q : kNone};
}

/// Samples [0, 1] with a density that changes linearly from `a` to `b`.
double sample_linear(double u, double a, double b) {
  const double root = std::sqrt((1 - u) * a * a + u * b * b);
  return a + root > 0 ? std::min(u * (a + b) / (a + root), 1.0) : u;
}

/// Bilinear patches over shared corners, in world space.
class BilinearMesh final : public AnalyticShape {
 public:
  explicit BilinearMesh(PatchMesh mesh, bool flip)
      : AnalyticShape(mesh.n.empty()), mesh_(std::move(mesh)), flip_(flip) {}

  unsigned count() const override { return unsigned(mesh_.patches.size()); }
  /// A patch lies within the convex hull of its corners.
  Bounds bounds(unsigned i) const override {
    Bounds bounds;
    for (const uint32_t k : mesh_.patches[i]) bounds.add(mesh_.p[k]);
    return bounds;
  }
  /// The corners, whose convex hull contains the patch.
  std::vector<Vec3> outline(unsigned i) const override {
    std::vector<Vec3> points;
    for (const uint32_t k : mesh_.patches[i]) points.push_back(mesh_.p[k]);
    return points;
  }

  /// Reshetov 2019, "Cool Patches": u at which the ray hits the line between the patch's two u-curves, then v and t.
  /// Parallelograms are intersected like triangles (Möller and Trumbore 1997), in half of the time.
  std::optional<ShapePoint> intersect(unsigned i, const Ray& ray, float t_min) const override {
    const Patch patch = patch_of(i);
    const Vec3d o = to_double(ray.o), d = to_double(ray.d);
    const Vec3d left = patch.p[2] - patch.p[0], right = patch.p[3] - patch.p[1];
    const Vec3d q0 = patch.p[0] - o, q1 = patch.p[1] - o;
    if (left == right) {
      const Vec3d side = patch.p[1] - patch.p[0], h = cross(d, left), k = cross(side, q0);
      const double det = dot(side, h), inverse = 1 / det;  // det is 0, but for rounding, of a ray in the plane
      const double u = -dot(q0, h) * inverse, v = dot(d, k) * inverse, t = dot(left, k) * inverse;
      if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1 && float(t) > t_min && t < double(ray.t_max))) return {};
      if (!(det * det > 1e-26 * dot(side, side) * dot(h, h))) return {};
      return at(i, patch, u, v, float(t));
    }
    const double a = dot(cross(q0, d), left), c = dot(cross(patch.p[1] - patch.p[0], patch.p[2] - patch.p[3]), d);
    const double b = dot(cross(q1, d), right) - a - c;
    double best_t = double(ray.t_max), best_u = 0, best_v = 0;
    bool found = false;
    for (const double u : quadratic_roots(a, b, c)) {
      if (!(u >= 0 && u <= 1)) continue;
      const Vec3d base = q0 * (1 - u) + q1 * u, side = left * (1 - u) + right * u, n = cross(d, side);
      const double det = dot(n, n);
      if (!(det > 0)) continue;  // the ray is parallel to this line of the patch
      const double t = dot(cross(n, base), side) / det, v = dot(cross(n, base), d) / det;
      if (!(v >= 0 && v <= 1 && float(t) > t_min && t < best_t)) continue;
      best_t = t, best_u = u, best_v = v, found = true;
    }
    if (!found) return {};
    return at(i, patch, best_u, best_v, float(best_t));
  }

  /// Samples a density bilinear in the area elements at the corners. The ratio to the true area element is bounded,
  /// because the normal is bilinear too. pbrt-v4 uses the same density.
  ShapePoint sample(unsigned i, Vec2 u) const override {
    const Patch patch = patch_of(i);
    const std::array<double, 4> w = corner_areas(patch);
    const double v = sample_linear(double(u.y), w[0] + w[1], w[2] + w[3]);
    const double at_u = sample_linear(double(u.x), std::lerp(w[0], w[2], v), std::lerp(w[1], w[3], v));
    const double density = std::lerp(std::lerp(w[0], w[2], v), std::lerp(w[1], w[3], v), at_u);
    ShapePoint point = at(i, patch, at_u, v, 0);
    const double mean = (w[0] + w[1] + w[2] + w[3]) / 4;
    point.area = density > 0 ? length(patch.normal(at_u, v)) * mean / density : 0;
    return point;
  }
  /// Integrates by Gauss's rule of four points over 4 x 4 cells. Flat patches with a constant normal need one
  /// evaluation.
  double area(unsigned i) const override {
    constexpr std::array kNodes{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
    constexpr std::array kWeights{0.17392742256872692, 0.32607257743127305, 0.32607257743127305, 0.17392742256872692};
    constexpr int kCells = 4;
    const Patch patch = patch_of(i);
    const std::array<double, 4> w = corner_areas(patch);
    if (w[0] == w[1] && w[0] == w[2] && w[0] == w[3]) return w[0];
    double sum = 0;
    for (int a = 0; a < kCells; ++a)
      for (int b = 0; b < kCells; ++b)
        for (size_t k = 0; k < kNodes.size(); ++k)
          for (size_t l = 0; l < kNodes.size(); ++l)
            sum += kWeights[k] * kWeights[l] * length(patch.normal((a + kNodes[k]) / kCells, (b + kNodes[l]) / kCells));
    return sum / (kCells * kCells);
  }

  Vec2 uv(unsigned i, Vec2 at) const override { return interpolate(texture_of(i), at); }

  /// Interpolates the corners' normals; not normalized.
  Vec3 shading_normal(unsigned i, Vec2 at) const override {
    std::array<Vec3, 4> n;
    for (size_t k = 0; k < 4; ++k) n[k] = mesh_.n[mesh_.patches[i][k]];
    return interpolate(n, at);
  }

  /// Derivatives by the patch's parameters, converted to texture coordinates by the inverse Jacobian.
  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const Patch patch = patch_of(point.primitive);
    const auto q = texture_of(point.primitive);
    const double u = double(point.at.x), v = double(point.at.y);
    const Vec3d du = patch.du(v), dv = patch.dv(u);
    const auto [dn_du, dn_dv] = normal_changes(patch, point, du, dv);
    const Vec2 s = (q[1] - q[0]) * (1 - point.at.y) + (q[3] - q[2]) * point.at.y;
    const Vec2 t = (q[2] - q[0]) * (1 - point.at.x) + (q[3] - q[1]) * point.at.x;
    // Where the map to texture coordinates is singular, the patch's own parameters are used.
    const double det = double(s.x) * double(t.y) - double(s.y) * double(t.x);
    if (det == 0) return {to_float(du), to_float(dv), to_float(dn_du), to_float(dn_dv)};
    const auto along = [&](const Vec3d& a, const Vec3d& b, double x, double y) {
      return to_float((a * x + b * y) / det);
    };
    return {along(du, dv, double(t.y), -double(s.y)), along(du, dv, -double(t.x), double(s.x)),
            along(dn_du, dn_dv, double(t.y), -double(s.y)), along(dn_du, dn_dv, -double(t.x), double(s.x))};
  }

 private:
  template <class T>
  /// Bilinear interpolation of values at the corners (0,0), (1,0), (0,1), (1,1).
  static T interpolate(const std::array<T, 4>& q, Vec2 at) {
    return (q[0] * (1 - at.x) + q[1] * at.x) * (1 - at.y) + (q[2] * (1 - at.x) + q[3] * at.x) * at.y;
  }
  /// Area elements at the corners, for sampling.
  static std::array<double, 4> corner_areas(const Patch& patch) {
    return {length(patch.normal(0, 0)), length(patch.normal(1, 0)), length(patch.normal(0, 1)),
            length(patch.normal(1, 1))};
  }

  /// Returns a patch in double precision.
  Patch patch_of(unsigned i) const {
    Patch patch;
    for (size_t k = 0; k < 4; ++k) patch.p[k] = to_double(mesh_.p[mesh_.patches[i][k]]);
    return patch;
  }
  /// Returns the corners' texture coordinates.
  std::array<Vec2, 4> texture_of(unsigned i) const {
    if (mesh_.uv.empty()) return {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
    std::array<Vec2, 4> q;
    for (size_t k = 0; k < 4; ++k) q[k] = mesh_.uv[mesh_.patches[i][k]];
    return q;
  }

  /// Derivatives of the unit shading normal by the patch's parameters.
  std::array<Vec3d, 2> normal_changes(const Patch& patch, const ShapePoint& point, const Vec3d& du,
                                      const Vec3d& dv) const {
    const double u = double(point.at.x), v = double(point.at.y);
    const auto unit_changes = [](const Vec3d& n, const Vec3d& a, const Vec3d& b) -> std::array<Vec3d, 2> {
      const double size = length(n);
      if (!(size > 0)) return {};
      const Vec3d unit = n / size;
      return {(a - unit * dot(unit, a)) / size, (b - unit * dot(unit, b)) / size};
    };
    if (!mesh_.n.empty()) {
      std::array<Vec3d, 4> n;
      for (size_t k = 0; k < 4; ++k) n[k] = to_double(mesh_.n[mesh_.patches[point.primitive][k]]);
      return unit_changes(to_double(shading_normal(point.primitive, point.at)),
                          (n[1] - n[0]) * (1 - v) + (n[3] - n[2]) * v, (n[2] - n[0]) * (1 - u) + (n[3] - n[1]) * u);
    }
    // Second derivative by u and v; those by u twice and v twice are 0.
    const Vec3d twist = patch.p[0] - patch.p[1] - patch.p[2] + patch.p[3];
    const auto [a, b] = unit_changes(cross(du, dv), cross(du, twist), cross(twist, dv));
    if (flip_) return {-a, -b};
    return {a, b};
  }

  /// Returns the point at (u, v).
  ShapePoint at(unsigned i, const Patch& patch, double u, double v, float t) const {
    const Vec3 n = to_float(normalize_any(patch.normal(u, v)));
    ShapePoint point{to_float(patch.at(u, v)), flip_ ? -n : n, {float(u), float(v)}, t, i};
    // The shading normals determine the front, as in pbrt-v4.
    if (!mesh_.n.empty() && dot(shading_normal(i, point.at), n) != 0)
      point.ng = dot(shading_normal(i, point.at), n) < 0 ? -n : n;
    return point;
  }

  PatchMesh mesh_;
  bool flip_;  ///< whether the front is opposite to the cross product of the derivatives
};

constexpr Param kBilinear[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Corners.", .list = true, .required = true},
    {.name = "N",
     .kind = ParamKind::normal3,
     .doc = "Shading normals, one for each corner; they also determine the front.",
     .list = true},
    {.name = "uv", .kind = ParamKind::point2, .doc = "Texture coordinates, one for each corner.", .list = true},
    {.name = "indices",
     .kind = ParamKind::integer,
     .doc = "Four corners for each patch: (0,0), (1,0), (0,1), (1,1).",
     .list = true},
    {.name = "faceIndices",
     .kind = ParamKind::integer,
     .doc = "Accepted for compatibility with pbrt-v4; ignored.",
     .list = true},
    {.name = "emissionfilename",
     .kind = ParamKind::string,
     .doc = "Accepted for compatibility with pbrt-v4; ignored: the emission does not depend on it."},
    kAlphaParam};

/// Four corners without indices are a single patch, as in pbrt-v4.
MadeShape make_bilinear(const Params& p, const ShapePlacement& placement) {
  PatchMesh mesh{.p = p.vec3s("P"), .n = p.vec3s("N"), .uv = p.vec2s("uv"), .patches = {}};
  auto indices = p.integers("indices");
  if (indices.empty() && mesh.p.size() == 4) indices = {0, 1, 2, 3};
  if (indices.empty() || indices.size() % 4 != 0)
    fail(p.where("indices"), "a bilinear mesh takes 4 indices for each patch, {} given", indices.size());
  if (!mesh.n.empty() && mesh.n.size() != mesh.p.size())
    fail(p.where("N"), "{} values of \"N\" for {} of \"P\"", mesh.n.size(), mesh.p.size());
  if (!mesh.uv.empty() && mesh.uv.size() != mesh.p.size())
    fail(p.where("uv"), "{} values of \"uv\" for {} of \"P\"", mesh.uv.size(), mesh.p.size());
  for (size_t i = 0; i < indices.size(); i += 4) {
    auto& patch = mesh.patches.emplace_back();
    for (size_t k = 0; k < 4; ++k) {
      const int index = indices[i + k];
      if (index < 0 || size_t(index) >= mesh.p.size())
        fail(p.where("indices"), "index {} is out of range: there are {} vertices", index, mesh.p.size());
      patch[k] = uint32_t(index);
    }
  }
  p.integers("faceIndices");
  if (p.given("emissionfilename")) p.string("emissionfilename");
  for (Vec3& at : mesh.p) at = placement.to_scene.point(at);
  place_normals(mesh.n, placement);
  return std::vector<ShapeGeometry>{patches(std::move(mesh), placement)};
}

}  // namespace

/// Reversed orientation and a transform that swaps handedness cancel.
AnalyticShapePtr patches(PatchMesh mesh, const ShapePlacement& placement) {
  const bool flip = placement.reverse_orientation != placement.to_scene.swaps_handedness();
  return std::make_shared<const BilinearMesh>(std::move(mesh), flip);
}

extern const ShapeInfo bilinear_mesh_shape{
    {"shape", "bilinearmesh", "Patches that are bilinear in (u, v).", "pbrt-v4", kBilinear}, make_bilinear};

}  // namespace frond
