#include <algorithm>
#include <array>

#include "core/error.h"
#include "scene/distribution.h"
#include "scene/registry.h"
#include "scene/shape.h"

namespace frond {
namespace {

/// One patch: corners at (u, v) = (0,0), (1,0), (0,1), (1,1).
struct Patch {
  std::array<Vec3d, 4> p;

  Vec3d at(double u, double v) const { return along_u(u, 0) * (1 - v) + along_u(u, 2) * v; }
  Vec3d du(double v) const { return (p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v; }
  Vec3d dv(double u) const { return (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u; }
  Vec3d normal(double u, double v) const { return cross(du(v), dv(u)); }

 private:
  Vec3d along_u(double u, size_t first) const { return p[first] * (1 - u) + p[first + 1] * u; }
};

/// Real roots of a + b x + c x^2, without cancellation.
std::array<double, 2> quadratic_roots(double a, double b, double c) {
  if (c == 0) return {-a / b, NAN};
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return {NAN, NAN};
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  return {q / c, q != 0 ? a / q : NAN};
}

class BilinearMesh final : public AnalyticShape {
 public:
  BilinearMesh(const Params& p, const ShapePlacement& placement) {
    const Transform& to_scene = placement.to_scene;
    flip_ = placement.reverse_orientation != to_scene.swaps_handedness();
    const auto corners = p.vec3s("P");
    const auto texture = p.vec2s("uv");
    auto indices = p.integers("indices");
    if (indices.empty() && corners.size() == 4) indices = {0, 1, 2, 3};
    if (indices.empty() || indices.size() % 4 != 0)
      fail(p.where("indices"), "a bilinear mesh takes 4 indices for each patch, {} given", indices.size());
    if (!texture.empty() && texture.size() != corners.size())
      fail(p.where("uv"), "{} values of \"uv\" for {} of \"P\"", texture.size(), corners.size());
    for (size_t i = 0; i < indices.size(); i += 4) add(p, to_scene, corners, texture, &indices[i]);
    std::vector<float> weights;
    for (const Patch& patch : patches_) weights.push_back(float(area_of(patch)));
    by_area_.emplace(weights);
    area_ = by_area_->sum();
  }

  unsigned count() const override { return unsigned(patches_.size()); }
  Bounds bounds(unsigned i) const override {
    Bounds bounds;
    for (const Vec3d& p : patches_[i].p) bounds.add(to_float(p));
    return bounds;
  }

  /// Reshetov 2019, "Cool Patches": the u where the ray meets the line between the patch's two u-curves, then v and t.
  std::optional<ShapePoint> intersect(unsigned i, const Ray& ray, float t_min) const override {
    const Patch& patch = patches_[i];
    const Vec3d o = to_double(ray.o), d = to_double(ray.d);
    const Vec3d left = patch.p[2] - patch.p[0], right = patch.p[3] - patch.p[1];
    const Vec3d q0 = patch.p[0] - o, q1 = patch.p[1] - o;
    const double a = dot(cross(q0, d), left), c = dot(cross(patch.p[1] - patch.p[0], patch.p[2] - patch.p[3]), d);
    const double b = dot(cross(q1, d), right) - a - c;
    double best_t = double(ray.t_max), best_u = 0, best_v = 0;
    bool found = false;
    for (const double u : quadratic_roots(a, b, c)) {
      if (!(u >= 0 && u <= 1)) continue;
      const Vec3d base = q0 * (1 - u) + q1 * u, side = left * (1 - u) + right * u, n = cross(d, side);
      const double det = dot(n, n), t = dot(cross(n, base), side) / det, v = dot(cross(n, base), d) / det;
      if (!(v >= 0 && v <= 1 && float(t) > t_min && t < best_t)) continue;
      best_t = t, best_u = u, best_v = v, found = true;
    }
    if (!found) return {};
    return at(i, best_u, best_v, float(best_t));
  }

  ShapePoint sample(Vec2 u) const override {
    const auto [i, fraction, pdf] = by_area_->sample(u.x);
    return at(unsigned(i), double(fraction), double(u.y), 0);
  }
  double area() const override { return area_; }

  Vec2 uv(unsigned i, Vec2 at) const override {
    const auto& q = uv_[i];
    return (q[0] * (1 - at.x) + q[1] * at.x) * (1 - at.y) + (q[2] * (1 - at.x) + q[3] * at.x) * at.y;
  }

  /// By the patch's parameters, then by the inverse of how texture coordinates change with those.
  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const Patch& patch = patches_[point.primitive];
    const auto& q = uv_[point.primitive];
    const double u = double(point.at.x), v = double(point.at.y);
    const Vec3d du = patch.du(v), dv = patch.dv(u), twist = patch.p[0] - patch.p[1] - patch.p[2] + patch.p[3];
    const Vec3d n = cross(du, dv), unit = normalize_any(n);
    const double size = length(n);
    const auto change = [&](const Vec3d& dn) {
      const Vec3d across = (dn - unit * dot(unit, dn)) / (flip_ ? -size : size);
      return size > 0 ? across : Vec3d{};
    };
    const Vec3d dn_du = change(cross(du, twist)), dn_dv = change(cross(twist, dv));
    const Vec2 s = (q[1] - q[0]) * (1 - point.at.y) + (q[3] - q[2]) * point.at.y;
    const Vec2 t = (q[2] - q[0]) * (1 - point.at.x) + (q[3] - q[1]) * point.at.x;
    const double det = double(s.x) * double(t.y) - double(s.y) * double(t.x);
    if (det == 0) return {to_float(du), to_float(dv), to_float(dn_du), to_float(dn_dv)};
    const auto along = [&](const Vec3d& a, const Vec3d& b, double x, double y) {
      return to_float((a * x + b * y) / det);
    };
    return {along(du, dv, double(t.y), -double(s.y)), along(du, dv, -double(t.x), double(s.x)),
            along(dn_du, dn_dv, double(t.y), -double(s.y)), along(dn_du, dn_dv, -double(t.x), double(s.x))};
  }

  /// Uniform in (u, v) is uniform in area on parallelograms alone.
  std::string_view cannot_emit() const override {
    const auto is_parallelogram = [](const Patch& q) {
      return length(q.p[0] + q.p[3] - q.p[1] - q.p[2]) <= 1e-5 * length(q.p[3] - q.p[0]);
    };
    return std::all_of(patches_.begin(), patches_.end(), is_parallelogram) ? "" : "its patches are not parallelograms";
  }

 private:
  void add(const Params& p, const Transform& to_scene, const std::vector<Vec3>& corners,
           const std::vector<Vec2>& texture, const int* index) {
    Patch patch;
    std::array<Vec2, 4> uv{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
    for (size_t k = 0; k < 4; ++k) {
      if (index[k] < 0 || size_t(index[k]) >= corners.size())
        fail(p.where("indices"), "index {} is out of range: there are {} vertices", index[k], corners.size());
      patch.p[k] = to_double(to_scene.point(corners[size_t(index[k])]));
      if (!texture.empty()) uv[k] = texture[size_t(index[k])];
    }
    patches_.push_back(patch);
    uv_.push_back(uv);
  }

  static double area_of(const Patch& patch) {
    constexpr int kSteps = 8;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) sum += length(patch.normal((i + 0.5) / kSteps, (j + 0.5) / kSteps));
    return sum / (kSteps * kSteps);
  }

  ShapePoint at(unsigned i, double u, double v, float t) const {
    const Patch& patch = patches_[i];
    const Vec3 ng = to_float(normalize_any(patch.normal(u, v)));
    return {to_float(patch.at(u, v)), flip_ ? -ng : ng, {float(u), float(v)}, t, i};
  }

  std::vector<Patch> patches_;
  std::vector<std::array<Vec2, 4>> uv_;
  std::optional<Distribution1D> by_area_;
  double area_ = 0;
  bool flip_ = false;
};

constexpr Param kBilinear[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Corners.", .list = true, .required = true},
    {.name = "uv", .kind = ParamKind::point2, .doc = "Texture coordinates, one for each corner.", .list = true},
    {.name = "indices",
     .kind = ParamKind::integer,
     .doc = "Four corners for each patch: (0,0), (1,0), (0,1), (1,1).",
     .list = true},
    kAlphaParam};

MadeShape make_bilinear(const Params& p, const ShapePlacement& placement) {
  return std::make_shared<const BilinearMesh>(p, placement);
}

}  // namespace

extern const ShapeInfo bilinear_mesh_shape{
    {"shape", "bilinearmesh", "Patches that are bilinear in (u, v).", "pbrt-v4", kBilinear}, make_bilinear};

}  // namespace frond
