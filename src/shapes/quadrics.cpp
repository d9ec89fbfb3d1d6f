#include <algorithm>

#include "core/error.h"
#include "core/math/affine_map.h"
#include "core/shape.h"

namespace frond {
namespace {

constexpr double kTau = 2 * M_PI;

/// Base of shapes defined in object space: transform, orientation and sweep angle.
class Quadric : public AnalyticShape {
 public:
  Quadric(const Params& p, const ShapePlacement& placement)
      : to_scene_(placement.to_scene),
        precise_(placement.to_scene),
        flip_(placement.reverse_orientation != placement.to_scene.swaps_handedness()),
        phi_max_(p.real("phimax") * M_PI / 180) {}

  /// Uniform over the area in object space; `area` corrects for the transform: 1 over the density.
  ShapePoint sample(unsigned, Vec2 u) const final {
    const Sample s = sample_object(u);
    ShapePoint point = s.point;
    point.area = area_at(s.normal);
    return point;
  }
  /// Area in world space: exact if the transform scales all areas alike, else by the midpoint rule.
  double area(unsigned) const final {
    if (AffineMap{to_scene_.rows()}.area_scale()) return object_area() * stretch({0, 0, 1});
    constexpr int kSteps = 128;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        sum += stretch(sample_object({(float(i) + 0.5f) / kSteps, (float(j) + 0.5f) / kSteps}).normal);
    return object_area() * sum / (kSteps * kSteps);
  }

 protected:
  /// A sample uniform over the area in object space; the normal is unit.
  struct Sample {
    ShapePoint point;
    Vec3d normal;
  };
  virtual Sample sample_object(Vec2 u) const = 0;
  /// Returns the area in object space.
  virtual double object_area() const = 0;
  /// Returns the area that the shape would have if it grew everywhere as at a point with this unit normal.
  virtual double area_at(const Vec3d& n) const { return object_area() * stretch(n); }

  /// Returns a unit normal.
  Vec3 to_scene_normal(const Vec3d& n) const {
    const Vec3 ng = normalize_any(to_scene_.normal(to_float(normalize_any(n))));
    return flip_ ? -ng : ng;
  }
  /// Rounds only in world space, because ray origins are offset by a hit's coordinates there.
  Vec3 to_scene_point(const Vec3d& p) const { return to_float(precise_.point(p)); }
  /// Converts derivatives from object space, at a point with unit normal `n` there.
  SurfaceDerivatives to_scene_derivatives(const Vec3d& n, const Vec3d& dpdu, const Vec3d& dpdv, const Vec3d& dndu,
                                          const Vec3d& dndv) const {
    const Vec3 grown = to_scene_.normal(to_float(n));
    const float size = length(grown);
    const Vec3 unit = grown / size;
    const auto change = [&](const Vec3d& dn) {
      const Vec3 d = to_scene_.normal(to_float(dn)) / size, across = d - unit * dot(unit, d);
      return flip_ ? -across : across;
    };
    return {to_scene_.vector(to_float(dpdu)), to_scene_.vector(to_float(dpdv)), change(dndu), change(dndv)};
  }
  /// Object-space coordinates in double precision, because radii may be small compared with positions.
  Vec3d local_point(const Vec3& p) const { return precise_.inverse_point(to_double(p)); }
  Vec3d local_vector(const Vec3& v) const { return precise_.inverse_vector(to_double(v)); }
  /// Bounds of a transformed box.
  Bounds transformed_box(const Vec3d& lo, const Vec3d& hi) const {
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner)
      bounds.add(to_scene_point({corner & 1 ? lo.x : hi.x, corner & 2 ? lo.y : hi.y, corner & 4 ? lo.z : hi.z}));
    return bounds;
  }
  /// Compares as float, as a search that continues behind the hit does.
  static bool is_in_range(double t, float t_min, const Ray& ray) { return float(t) > t_min && float(t) < ray.t_max; }
  /// Returns the azimuth in [0, 2 pi).
  static double azimuth(const Vec3d& p) {
    const double phi = std::atan2(p.y, p.x);
    return phi < 0 ? phi + kTau : phi;
  }
  double phi_max() const { return phi_max_; }
  const Transform& to_scene() const { return to_scene_; }

 private:
  /// Returns the transform's factor on areas with this unit normal.
  double stretch(const Vec3d& n) const { return double(length(AffineMap{to_scene_.rows()}.normal(to_float(n)))); }

  Transform to_scene_;
  PreciseTransform precise_;
  bool flip_;       ///< whether the front is opposite to the object-space normal
  double phi_max_;  ///< radians
};

/// Sphere around the origin, optionally cut at two heights and at a sweep angle.
class Sphere final : public Quadric {
 public:
  Sphere(const Params& p, const ShapePlacement& placement) : Quadric(p, placement), radius_(p.real("radius")) {
    const double z0 = p.given("zmin") ? p.real("zmin") : -radius_, z1 = p.given("zmax") ? p.real("zmax") : radius_;
    z_min_ = std::clamp(std::min(z0, z1), -radius_, radius_);
    z_max_ = std::clamp(std::max(z0, z1), -radius_, radius_);
    if (z_min_ == z_max_)
      fail(p.where("zmin"), "the sphere is empty: zmin {} and zmax {} with radius {}", z0, z1, radius_);
  }

  /// Ignores the sweep angle.
  Bounds bounds(unsigned) const override {
    return transformed_box({-radius_, -radius_, z_min_}, {radius_, radius_, z_max_});
  }

  std::optional<ShapePoint> intersect(unsigned, const Ray& ray, float t_min) const override {
    const Vec3d o = local_point(ray.o), d = local_vector(ray.d);
    // The line's distance from the centre is computed first, so that the discriminant does not cancel for distant
    // origins.
    const double dd = dot(d, d), b = -dot(o, d) / dd;
    const Vec3d closest = o + d * b;
    const double discriminant = radius_ * radius_ - dot(closest, closest);
    if (discriminant < 0) return {};
    const double half = std::sqrt(discriminant / dd);
    for (const double t : {b - half, b + half}) {
      if (!is_in_range(t, t_min, ray)) continue;
      const Vec3d on_ray = o + d * t, p = on_ray * (radius_ / length(on_ray));
      const double phi = azimuth(p);
      if (p.z < z_min_ || p.z > z_max_ || phi > phi_max()) continue;
      return at(p, phi, float(t));
    }
    return {};
  }

  /// z is uniform, by Archimedes' theorem.
  Sample sample_object(Vec2 u) const override {
    const double z = z_min_ + double(u.x) * (z_max_ - z_min_), phi = double(u.y) * phi_max();
    const double r = std::sqrt(std::max(0.0, radius_ * radius_ - z * z));
    const Vec3d p{r * std::cos(phi), r * std::sin(phi), z};
    return {at(p, phi, 0), p / radius_};
  }
  double object_area() const override { return phi_max() * radius_ * (z_max_ - z_min_); }

  /// As in pbrt-v4: u is the azimuth, v the polar angle.
  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const Vec3d p = local_point(point.p);
    const double ring = std::hypot(p.x, p.y), sweep = std::acos(z_max_ / radius_) - std::acos(z_min_ / radius_);
    const double cos_phi = ring > 0 ? p.x / ring : 1, sin_phi = ring > 0 ? p.y / ring : 0;
    const Vec3d dpdu = Vec3d{-p.y, p.x, 0} * phi_max(), dpdv = Vec3d{p.z * cos_phi, p.z * sin_phi, -ring} * sweep;
    return to_scene_derivatives(p / radius_, dpdu, dpdv, dpdu / radius_, dpdv / radius_);
  }

 private:
  /// Returns the point with its parameters, in world space.
  ShapePoint at(const Vec3d& p, double phi, float t) const {
    const double theta = std::acos(std::clamp(p.z / radius_, -1.0, 1.0));
    const double bottom = std::acos(z_min_ / radius_), top = std::acos(z_max_ / radius_);
    return {
        to_scene_point(p), to_scene_normal(p), {float(phi / phi_max()), float((theta - bottom) / (top - bottom))}, t};
  }

  double radius_, z_min_ = 0, z_max_ = 0;  ///< object space, z_min_ < z_max_
};

/// Flat disk at a height, optionally with a hole and a sweep angle.
class Disk final : public Quadric {
 public:
  Disk(const Params& p, const ShapePlacement& placement)
      : Quadric(p, placement),
        radius_(p.real("radius")),
        inner_(p.real("innerradius")),
        height_(p.real("height")),
        ng_(to_scene_normal({0, 0, 1})),
        area_(Quadric::area_at({0, 0, 1})) {
    if (inner_ >= radius_)
      fail(p.where("innerradius"), "\"innerradius\" {} must be less than \"radius\" {}", inner_, radius_);
  }

  Bounds bounds(unsigned) const override {
    return transformed_box({-radius_, -radius_, height_}, {radius_, radius_, height_});
  }

  /// The hit point's z is set exactly, so that it lies in the plane.
  std::optional<ShapePoint> intersect(unsigned, const Ray& ray, float t_min) const override {
    const Vec3d o = local_point(ray.o), d = local_vector(ray.d);
    if (d.z == 0) return {};
    const double t = (height_ - o.z) / d.z;
    if (!is_in_range(t, t_min, ray)) return {};
    const Vec3d p{o.x + t * d.x, o.y + t * d.y, height_};
    const double r = std::sqrt(p.x * p.x + p.y * p.y);  // hypot is slower; the product of floats cannot overflow
    if (r > radius_ || r < inner_) return {};
    const double phi = azimuth(p);
    if (phi > phi_max()) return {};
    return at(p, r, phi, float(t));
  }

  /// Returns a polygon around the disk.
  std::vector<Vec3> outline(unsigned) const override {
    constexpr int kCorners = 16;
    std::vector<Vec3> points;
    for (int i = 0; i < kCorners; ++i) {
      const double phi = kTau * i / kCorners, r = radius_ / std::cos(kTau / 2 / kCorners);
      points.push_back(to_scene_point({r * std::cos(phi), r * std::sin(phi), height_}));
    }
    return points;
  }

  /// The squared radius is uniform.
  Sample sample_object(Vec2 u) const override {
    const double r = std::sqrt(inner_ * inner_ + double(u.x) * (radius_ * radius_ - inner_ * inner_));
    const double phi = double(u.y) * phi_max();
    return {at({r * double(std::cos(float(phi))), r * double(std::sin(float(phi))), height_}, r, phi, 0), {0, 0, 1}};
  }
  double object_area() const override { return phi_max() / 2 * (radius_ * radius_ - inner_ * inner_); }
  double area_at(const Vec3d&) const override { return area_; }

  /// As in pbrt-v4, v decreases from the hole to the rim.
  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const Vec3d p = local_point(point.p);
    const double r = std::hypot(p.x, p.y);
    const Vec3d outward = r > 0 ? Vec3d{p.x / r, p.y / r, 0} : Vec3d{1, 0, 0};
    return to_scene_derivatives({0, 0, 1}, Vec3d{-p.y, p.x, 0} * phi_max(), outward * (inner_ - radius_), {}, {});
  }

 private:
  /// Returns the point with its parameters, in world space; `r` is the distance from the axis.
  ShapePoint at(const Vec3d& p, double r, double phi, float t) const {
    return {to_scene_point(p), ng_, {float(phi / phi_max()), float((radius_ - r) / (radius_ - inner_))}, t};
  }

  double radius_, inner_, height_;  ///< object space
  Vec3 ng_;
  double area_;
};

/// Open cylinder around the z axis.
class Cylinder final : public Quadric {
 public:
  Cylinder(const Params& p, const ShapePlacement& placement)
      : Quadric(p, placement),
        radius_(p.real("radius")),
        z_min_(std::min(p.real("zmin"), p.real("zmax"))),
        z_max_(std::max(p.real("zmin"), p.real("zmax"))) {
    if (z_min_ == z_max_) fail(p.where("zmax"), "the cylinder is empty: zmin and zmax are {}", z_min_);
  }

  /// Bounds of the transformed rims, which are ellipses: tighter than a transformed box.
  Bounds bounds(unsigned) const override {
    Bounds bounds;
    const Transform::Rows& rows = to_scene().rows();
    const auto reach = [&](size_t i) { return float(radius_ * std::hypot(double(rows[i][0]), double(rows[i][1]))); };
    const Vec3 by{reach(0), reach(1), reach(2)};
    for (const double z : {z_min_, z_max_}) {
      const Vec3 centre = to_scene_point({0, 0, z});
      bounds.add(centre - by), bounds.add(centre + by);
    }
    return bounds;
  }
  /// Corners of the transformed box.
  std::vector<Vec3> outline(unsigned) const override {
    std::vector<Vec3> points;
    for (const double z : {z_min_, z_max_})
      for (const double x : {-radius_, radius_})
        for (const double y : {-radius_, radius_}) points.push_back(to_scene_point({x, y, z}));
    return points;
  }

  /// Rays parallel to the axis miss.
  std::optional<ShapePoint> intersect(unsigned, const Ray& ray, float t_min) const override {
    const Vec3d o = local_point(ray.o), d = local_vector(ray.d);
    const double dd = d.x * d.x + d.y * d.y;
    if (dd == 0) return {};
    // As for the sphere: starts from the point of the line nearest to the axis.
    const double b = -(o.x * d.x + o.y * d.y) / dd, x = o.x + b * d.x, y = o.y + b * d.y;
    const double discriminant = radius_ * radius_ - (x * x + y * y);
    if (discriminant < 0) return {};
    const double half = std::sqrt(discriminant / dd);
    for (const double t : {b - half, b + half}) {
      if (!is_in_range(t, t_min, ray)) continue;
      Vec3d p = o + d * t;
      if (!(p.z >= z_min_ && p.z <= z_max_)) continue;
      const double phi = azimuth(p);
      if (phi > phi_max()) continue;
      const double to_surface = radius_ / std::hypot(p.x, p.y);
      p.x *= to_surface, p.y *= to_surface;
      return at(p, phi, float(t));
    }
    return {};
  }

  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const Vec3d p = local_point(point.p), n = normalize_any(Vec3d{p.x, p.y, 0});
    const Vec3d dpdu = Vec3d{-p.y, p.x, 0} * phi_max();
    return to_scene_derivatives(n, dpdu, {0, 0, z_max_ - z_min_}, dpdu / radius_, {});
  }

 private:
  Sample sample_object(Vec2 u) const override {
    const double z = z_min_ + double(u.x) * (z_max_ - z_min_), phi = double(u.y) * phi_max();
    const Vec3d n{std::cos(phi), std::sin(phi), 0};
    return {at({radius_ * n.x, radius_ * n.y, z}, phi, 0), n};
  }
  double object_area() const override { return phi_max() * radius_ * (z_max_ - z_min_); }

  ShapePoint at(const Vec3d& p, double phi, float t) const {
    return {to_scene_point(p),
            to_scene_normal({p.x, p.y, 0}),
            {float(phi / phi_max()), float((p.z - z_min_) / (z_max_ - z_min_))},
            t};
  }

  double radius_, z_min_, z_max_;  ///< object space, z_min_ < z_max_
};

constexpr Param kPhiMax{.name = "phimax",
                        .kind = ParamKind::real,
                        .default_value = 360.0,
                        .unit = "degrees",
                        .range = {1e-3, 360},
                        .doc = "Sweep angle.",
                        .quantity = PhysicalQuantity::sweep};
constexpr Interval kRadius{0, 1e30};
constexpr Param kSphere[] = {
    {.name = "radius", .kind = ParamKind::real, .default_value = 1.0, .range = kRadius, .doc = "Radius."},
    {.name = "zmin", .kind = ParamKind::real, .doc = "Lower end along z; by default the whole sphere."},
    {.name = "zmax", .kind = ParamKind::real, .doc = "Upper end along z; by default the whole sphere."},
    kPhiMax,
    kAlphaParam};
constexpr Param kDisk[] = {
    {.name = "radius", .kind = ParamKind::real, .default_value = 1.0, .range = kRadius, .doc = "Outer radius."},
    {.name = "innerradius",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .range = kAtLeastZero,
     .doc = "Radius of the hole."},
    {.name = "height", .kind = ParamKind::real, .default_value = 0.0, .doc = "Position along z."},
    kPhiMax,
    kAlphaParam};

constexpr Param kCylinder[] = {
    {.name = "radius", .kind = ParamKind::real, .default_value = 1.0, .range = kRadius, .doc = "Radius."},
    {.name = "zmin", .kind = ParamKind::real, .default_value = -1.0, .doc = "Lower end along z."},
    {.name = "zmax", .kind = ParamKind::real, .default_value = 1.0, .doc = "Upper end along z."},
    kPhiMax,
    kAlphaParam};

/// A shape of radius 0 has no surface, as in pbrt-v4.
template <class T>
MadeShape make_quadric(const Params& p, const ShapePlacement& placement) {
  constexpr double kLeast = 1e-30;
  if (p.real("radius") < kLeast) {
    p.warn("radius", "the shape has no surface: its radius is 0");
    return std::vector<ShapeGeometry>{};
  }
  return std::vector<ShapeGeometry>{std::make_shared<const T>(p, placement)};
}

}  // namespace

extern const ShapeInfo sphere_shape{{"shape", "sphere", "Sphere or part of one.", "pbrt-v4", kSphere},
                                    make_quadric<Sphere>};
extern const ShapeInfo disk_shape{{"shape", "disk", "Flat disk or ring.", "pbrt-v4", kDisk}, make_quadric<Disk>};
extern const ShapeInfo cylinder_shape{{"shape", "cylinder", "Open cylinder or part of one.", "pbrt-v4", kCylinder},
                                      make_quadric<Cylinder>};

}  // namespace frond
