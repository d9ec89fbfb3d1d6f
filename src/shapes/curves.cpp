#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/math/affine_map.h"
#include "core/shape.h"

namespace frond {
namespace {

/// Control points of a cubic Bezier curve.
template <class T>
using CubicT = std::array<Vec3T<T>, 4>;
// Control points are stored as floats; intersections are computed in double precision.
using Cubic = CubicT<float>;
using Cubicd = CubicT<double>;

template <class T>
Vec3T<T> interpolate(const Vec3T<T>& a, const Vec3T<T>& b, T t) {
  return a * (1 - t) + b * t;
}

/// De Casteljau subdivision at t: the two halves have the points 0 1 2 3 and 3 4 5 6.
std::array<Vec3d, 7> split(const Cubicd& c, double t) {
  const Vec3d a = interpolate(c[0], c[1], t), m = interpolate(c[1], c[2], t), b = interpolate(c[2], c[3], t);
  const Vec3d l = interpolate(a, m, t), r = interpolate(m, b, t);
  return {c[0], a, l, interpolate(l, r, t), r, b, c[3]};
}
/// Control points of the curve from 0 to t, of the result of `split`.
Cubicd first_part(const std::array<Vec3d, 7>& s) { return {s[0], s[1], s[2], s[3]}; }
/// Control points of the curve from t to 1.
Cubicd second_part(const std::array<Vec3d, 7>& s) { return {s[3], s[4], s[5], s[6]}; }

/// Returns the tangent, scaled as the derivative by t.
Vec3d derivative(const Cubicd& c, double t) {
  const Vec3d a = interpolate(c[0], c[1], t), m = interpolate(c[1], c[2], t), b = interpolate(c[2], c[3], t);
  const Vec3d d = interpolate(m, b, t) - interpolate(a, m, t);
  // If control points coincide, the direction from end to end is used.
  return (dot(d, d) > 0 ? d : c[3] - c[0]) * 3.0;
}

Cubicd to_double(const Cubic& c) {
  return {frond::to_double(c[0]), frond::to_double(c[1]), frond::to_double(c[2]), frond::to_double(c[3])};
}

enum class CurveKind : uint8_t { flat, cylinder, ribbon };

/// A chain of Bezier curves whose width changes linearly from the first end to the last. A ray hits the strip that
/// faces it (for a ribbon: the strip oriented by its normals) if it passes within the width (Nakamaru and Ohno 2002, as
/// in pbrt-v4). "cylinder" has the normals of a tube across the strip.
class Curves final : public AnalyticShape {
 public:
  Curves(std::vector<Cubic> segments, Vec2 widths, CurveKind kind, std::vector<Vec3> normals,
         const ShapePlacement& placement)
      : AnalyticShape(false),
        segments_(std::move(segments)),
        normals_(std::move(normals)),
        widths_(widths),
        kind_(kind),
        to_scene_(placement.to_scene),
        from_scene_(placement.to_scene.inverse()),
        precise_(placement.to_scene),
        flip_(placement.reverse_orientation != placement.to_scene.swaps_handedness()) {
    const Transform::Rows& r = to_scene_.rows();
    const Vec3 x{r[0][0], r[1][0], r[2][0]}, y{r[0][1], r[1][1], r[2][1]}, z{r[0][2], r[1][2], r[2][2]};
    // Geometric mean of the scale factors along the axes: the cube root of the determinant.
    scale_ = std::cbrt(std::abs(dot(cross(x, y), z)));
    chords_.reserve(count());
    for (unsigned i = 0; i < count(); ++i) chords_.push_back(chord_of(piece_of(i)));
  }

  unsigned count() const override { return unsigned(segments_.size()) * kPieces; }

  /// Bounds of the control points, enlarged by half of the larger width.
  Bounds bounds(unsigned primitive) const override {
    const Piece piece = piece_of(primitive);
    const float r = float(std::max(width(piece.segment, piece.u0), width(piece.segment, piece.u1)) / 2);
    const Transform::Rows& rows = to_scene_.rows();
    const auto reach = [&](size_t i) { return r * length(Vec3{rows[i][0], rows[i][1], rows[i][2]}); };
    const Vec3 by{reach(0), reach(1), reach(2)};
    Bounds bounds;
    for (const Vec3d& p : piece.curve) {
      const Vec3 at = to_scene_.point(to_float(p));
      bounds.add(at - by), bounds.add(at + by);
    }
    return bounds;
  }

  /// The curve is transformed to ray space, split recursively, and tested as line segments.
  std::optional<ShapePoint> intersect(unsigned primitive, const Ray& ray, float t_min) const override {
    const Vec3d o = precise_.inverse_point(frond::to_double(ray.o));
    const Vec3d d = precise_.inverse_vector(frond::to_double(ray.d));
    if (chords_[primitive].is_far_from(o, d)) return {};
    const Piece piece = piece_of(primitive);
    // Ray space with the ray along z and the curve roughly along x gives tight bounding boxes.
    const double ray_length = length(d);
    const Framed ray_space = Framed::along(d / ray_length, piece.curve[3] - piece.curve[0]);
    Search search{.curves = *this,
                  .segment = piece.segment,
                  .direction = d / ray_length,
                  .nearest = double(ray.t_max) * ray_length,
                  .least = double(t_min) * ray_length};
    Cubicd projected;
    for (size_t i = 0; i < 4; ++i) projected[i] = ray_space.to_local(piece.curve[i] - o);
    search.search(projected, piece.u0, piece.u1, depth_for(projected));
    const float t = float(search.nearest / ray_length);
    if (!search.found || !(t > t_min && t < ray.t_max)) return {};
    const Vec3d n = normal_at(search.hit, ray_space, piece.segment);
    return ShapePoint{to_float(precise_.point(o + d * (search.nearest / ray_length))),
                      to_scene_normal(n),
                      {float(search.hit.u), float(search.hit.v)},
                      t,
                      primitive};
  }

  /// Rays start outside of the strip that would face them, at pbrt-v4's distance: a width along each axis.
  float clearance(const ShapePoint& at) const override {
    const double w = width(at.primitive / kPieces, double(at.at.x)) * double(scale_);
    return float(w) * (std::abs(at.ng.x) + std::abs(at.ng.y) + std::abs(at.ng.z));
  }

  /// u runs along the segment, v across the strip.
  SurfaceDerivatives derivatives(const ShapePoint& point) const override {
    const size_t segment = point.primitive / kPieces;
    const double u = double(point.at.x);
    const Vec3d dpdu = derivative(to_double(segments_[segment]), u);
    const Vec3d n = frond::to_double(from_scene_.normal(flip_ ? -point.ng : point.ng));
    const Vec3d dpdv = normalize_any(cross(n, dpdu)) * width(segment, u);
    return {to_scene_.vector(to_float(dpdu)), to_scene_.vector(to_float(dpdv)), {}, {}};
  }

  /// Samples a strip with a random orientation about the curve.
  ShapePoint sample(unsigned primitive, Vec2 u) const override {
    const Piece piece = piece_of(primitive);
    const double t = double(u.x), own_u = piece.u0 + (piece.u1 - piece.u0) * t, w = width(piece.segment, own_u);
    const Vec3d along = derivative(piece.curve, t);
    const Framed frame = Framed::around(normalize_any(along));
    const Vec3d p = split(piece.curve, t)[3] + frame.x * (w * (double(u.y) - 0.5));
    const double area = length(along) * w * double(scale_) * double(scale_);
    return {to_scene_.point(to_float(p)), to_scene_normal(frame.y), {float(own_u), u.y}, 0, primitive, area};
  }
  /// Mean area of sampled strips.
  double area(unsigned primitive) const override {
    constexpr int kSteps = 16;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += sample(primitive, {(float(i) + 0.5f) / kSteps, 0.5f}).area;
    return sum / kSteps;
  }
  std::string_view cannot_emit() const override { return "a curve faces each ray"; }

 private:
  /// Number of pieces of each Bezier curve, for tighter bounding boxes.
  static constexpr unsigned kPieces = 4;

  /// Part of a segment from u0 to u1, an Embree primitive of its own.
  struct Piece {
    size_t segment;
    double u0, u1;
    Cubicd curve;
  };
  /// Returns a piece of a segment by subdivision at both ends.
  Piece piece_of(unsigned primitive) const {
    const unsigned k = primitive % kPieces;
    Piece piece{primitive / kPieces, double(k) / kPieces, double(k + 1) / kPieces, {}};
    piece.curve = to_double(segments_[piece.segment]);
    if (k > 0) piece.curve = second_part(split(piece.curve, piece.u0));
    if (k + 1 < kPieces) piece.curve = first_part(split(piece.curve, 1.0 / (kPieces - k)));
    return piece;
  }

  /// The line through the ends of a piece. Most rays that meet a piece's bounding box pass this line at more than
  /// `radius`, which encloses the piece with its width. 112 bytes for each Bezier curve.
  struct Chord {
    Vec3 from, along;
    float radius;

    /// Whether the line from `o` along `d` is further away than the radius; not if the lines are parallel.
    bool is_far_from(const Vec3d& o, const Vec3d& d) const {
      const Vec3d across = cross(d, frond::to_double(along));
      const double volume = dot(frond::to_double(from) - o, across), r = double(radius);
      return volume * volume > r * r * dot(across, across);
    }
  };
  Chord chord_of(const Piece& piece) const {
    const Cubicd& c = piece.curve;
    const Vec3d along = c[3] - c[0], direction = normalize_any(along);
    double away = 0, size = 0;
    for (const Vec3d& p : c) {
      away = std::max(away, length(cross(direction, p - c[0])));
      size = std::max({size, length(p), length(p - c[0])});
    }
    constexpr double kRounding = 1e-6;  // of the numbers of a chord, which are floats
    const double wide = std::max(width(piece.segment, piece.u0), width(piece.segment, piece.u1)) / 2;
    return {to_float(c[0]), to_float(along), float(away + wide + kRounding * (size + wide))};
  }

  /// Width at a parameter of a segment, interpolated along the whole chain.
  double width(size_t segment, double u) const {
    return std::lerp(double(widths_.x), double(widths_.y), (double(segment) + u) / double(segments_.size()));
  }

  /// Normal of a ribbon, interpolated along the segment by the shorter rotation; unit.
  Vec3d ribbon_normal(size_t segment, double u) const {
    const Vec3d a = frond::to_double(normals_[segment]), b = frond::to_double(normals_[segment + 1]);
    const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0)), sine = std::sin(angle);
    if (sine < 1e-6) return u < 0.5 ? a : b;
    // Spherical linear interpolation (Shoemake 1985).
    return (a * std::sin((1 - u) * angle) + b * std::sin(u * angle)) / sine;
  }

  /// Number of subdivisions until the pieces deviate from straight lines by at most about 1/20 of the width. Wang 1984:
  /// n pieces of a curve of degree d deviate by at most d (d - 1) / 8 of its largest second difference over n^2.
  /// Rounded down as in pbrt-v4, because the number of pieces is visible.
  int depth_for(const Cubicd& c) const {
    double largest = 0;
    for (size_t i = 1; i <= 2; ++i) {
      const Vec3d bend = c[i - 1] + c[i + 1] - c[i] * 2.0;
      largest = std::max({largest, std::abs(bend.x), std::abs(bend.y), std::abs(bend.z)});
    }
    const double in_plane = std::sqrt(2.0) * largest, slack = double(std::max(widths_.x, widths_.y)) / 20;
    constexpr int kDeepest = 10;
    int depth = 0;
    for (double pieces_squared = 3 * 2 / 8.0 * in_plane / slack; pieces_squared >= 4 && depth < kDeepest; ++depth)
      pieces_squared /= 4;
    return depth;
  }

  /// Parameters of a hit: u along the segment, v across the strip, both 0 to 1, and the strip's width there.
  struct CurveHit {
    double u, v, width;
  };

  /// Search for the nearest intersection of the z axis with a curve.
  struct Search {
    const Curves& curves;
    size_t segment;
    Vec3d direction;        ///< direction of the ray in the curve's space, unit
    double nearest, least;  ///< range along z
    bool found = false;
    CurveHit hit{};

    void search(const Cubicd& c, double u0, double u1, int depth) {
      if (!bounds_overlap(c, std::max(curves.width(segment, u0), curves.width(segment, u1)) / 2)) return;
      if (depth == 0) return intersect_piece(c, u0, u1);
      const std::array<Vec3d, 7> halves = split(c, 0.5);
      const double middle = (u0 + u1) / 2;
      search(first_part(halves), u0, middle, depth - 1);
      search(second_part(halves), middle, u1, depth - 1);
    }

    /// Whether the ray, along z, may hit the curve, from bounds of its control points enlarged by `radius`.
    bool bounds_overlap(const Cubicd& c, double radius) const {
      const auto [x0, x1] = std::minmax({c[0].x, c[1].x, c[2].x, c[3].x});
      const auto [y0, y1] = std::minmax({c[0].y, c[1].y, c[2].y, c[3].y});
      const auto [z0, z1] = std::minmax({c[0].z, c[1].z, c[2].z, c[3].z});
      return x0 <= radius && x1 >= -radius && y0 <= radius && y1 >= -radius && z0 - radius <= nearest &&
             z1 + radius >= least;
    }

    /// Intersects an almost straight piece: between the perpendiculars at its ends, and within its width.
    void intersect_piece(const Cubicd& c, double u0, double u1) {
      const auto beyond = [](const Vec3d& end, const Vec3d& inner) {
        return -end.y * (inner.y - end.y) - end.x * (inner.x - end.x) < 0;
      };
      if (beyond(c[0], c[1]) || beyond(c[3], c[2])) return;
      const double x = c[3].x - c[0].x, y = c[3].y - c[0].y, square = x * x + y * y;
      if (!(square > 0)) return;
      const double w = std::clamp(-(c[0].x * x + c[0].y * y) / square, 0.0, 1.0), u = u0 + (u1 - u0) * w;
      double width = curves.width(segment, u);
      if (curves.kind_ == CurveKind::ribbon) width *= std::abs(dot(curves.ribbon_normal(segment, u), direction));
      const Vec3d p = split(c, w)[3];
      const double distance = std::hypot(p.x, p.y);
      if (!(width > 0 && distance <= width / 2 && p.z > least && p.z < nearest)) return;
      const Vec3d along = derivative(c, w);
      const bool is_left = along.y * p.x - along.x * p.y > 0;
      nearest = p.z;
      found = true;
      hit = {u, 0.5 + (is_left ? distance : -distance) / width, width};
    }
  };

  /// Returns a normal in the curve's space, not normalized.
  Vec3d normal_at(const CurveHit& hit, const Framed& ray_space, size_t segment) const {
    const Vec3d dpdu = derivative(to_double(segments_[segment]), hit.u);
    if (kind_ == CurveKind::ribbon) return cross(dpdu, cross(ribbon_normal(segment, hit.u), dpdu));
    const Vec3d along = normalize_any(dpdu);
    const Vec3d in_plane = ray_space.to_local(along);
    Vec3d across = normalize_any(Vec3d{-in_plane.y, in_plane.x, 0});
    if (across == Vec3d{}) across = {1, 0, 0};
    across = ray_space.to_world(across);
    const Vec3d n = cross(along, across);
    if (kind_ == CurveKind::flat) return n;
    const double angle = -(hit.v - 0.5) * M_PI;
    return n * std::cos(angle) - across * std::sin(angle);
  }

  /// Returns a unit normal, flipped by ReverseOrientation.
  Vec3 to_scene_normal(const Vec3d& n) const {
    const Vec3 ng = normalize_any(to_scene_.normal(to_float(normalize_any(n))));
    return flip_ ? -ng : ng;
  }

  std::vector<Cubic> segments_;  ///< in object space
  std::vector<Chord> chords_;    ///< of the pieces; in object space
  std::vector<Vec3> normals_;    ///< of a ribbon, at the ends of segments; unit
  Vec2 widths_;
  CurveKind kind_;
  Transform to_scene_, from_scene_;
  PreciseTransform precise_;
  bool flip_;
  float scale_;  ///< mean scale factor of lengths
};

/// Raises a quadratic Bezier curve to a cubic one, exactly.
Cubic elevate_degree(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a, interpolate(a, b, 2.f / 3), interpolate(c, b, 2.f / 3), c};
}

/// Returns the Bezier curves of a chain with shared end points, or of a uniform B-spline.
std::vector<Cubic> segments_of(const std::vector<Vec3>& p, size_t degree, bool is_spline) {
  std::vector<Cubic> segments;
  for (size_t i = 0; i + degree < p.size(); i += is_spline ? 1 : degree) {
    const Vec3* const c = &p[i];
    if (degree == 2)
      segments.push_back(is_spline ? elevate_degree((c[0] + c[1]) * 0.5f, c[1], (c[1] + c[2]) * 0.5f)
                                   : elevate_degree(c[0], c[1], c[2]));
    else if (is_spline)
      segments.push_back({(c[0] + c[1] * 4.f + c[2]) / 6.f, interpolate(c[1], c[2], 1.f / 3),
                          interpolate(c[1], c[2], 2.f / 3), (c[1] + c[2] * 4.f + c[3]) / 6.f});
    else
      segments.push_back({c[0], c[1], c[2], c[3]});
  }
  return segments;
}

constexpr std::string_view kKinds[] = {"flat", "cylinder", "ribbon"};
constexpr std::string_view kBases[] = {"bezier", "bspline"};
constexpr Interval kWidth{0, 1e30};
constexpr Param kCurve[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Control points.", .list = true, .required = true},
    {.name = "type",
     .kind = ParamKind::string,
     .default_value = std::string_view("flat"),
     .doc = "flat: strip that faces each ray; cylinder: the same, shaded as a tube; ribbon: strip oriented by \"N\".",
     .choices = kKinds},
    {.name = "basis",
     .kind = ParamKind::string,
     .default_value = std::string_view("bezier"),
     .doc = "Basis of the control points.",
     .choices = kBases},
    {.name = "degree", .kind = ParamKind::integer, .default_value = 3, .range = {2, 3}, .doc = "Degree of the curve."},
    {.name = "width", .kind = ParamKind::real, .default_value = 1.0, .range = kWidth, .doc = "Width."},
    {.name = "width0", .kind = ParamKind::real, .range = kWidth, .doc = "Width at the start; by default \"width\"."},
    {.name = "width1", .kind = ParamKind::real, .range = kWidth, .doc = "Width at the end; by default \"width\"."},
    {.name = "N",
     .kind = ParamKind::normal3,
     .doc = "Normals of a ribbon: at the start, and at the end of each segment.",
     .list = true},
    {.name = "splitdepth",
     .kind = ParamKind::integer,
     .default_value = 3,
     .doc = "Accepted for compatibility with pbrt-v4; ignored."},
    kAlphaParam};

/// The number of control points must match degree and basis.
MadeShape make_curve(const Params& p, const ShapePlacement& placement) {
  const std::vector<Vec3> points = p.vec3s("P");
  const bool is_spline = p.string("basis") == "bspline";
  const auto degree = size_t(p.integer("degree"));
  p.integer("splitdepth");
  const size_t n = points.size();
  if (n < degree + 1 || (!is_spline && (n - 1) % degree != 0))
    fail(p.where("P"), "a {} curve of degree {} takes {} control points{}, {} given", p.string("basis"), degree,
         degree + 1, is_spline ? " or more" : fmt::format(", and {} for each further segment", degree), n);
  std::vector<Cubic> segments = segments_of(points, degree, is_spline);

  const std::string type = p.string("type");
  const CurveKind kind = type == "flat"       ? CurveKind::flat
                         : type == "cylinder" ? CurveKind::cylinder
                                              : CurveKind::ribbon;
  std::vector<Vec3> normals = p.vec3s("N");
  if (kind != CurveKind::ribbon) {
    if (!normals.empty()) p.warn("N", "normals are a ribbon's: they are not used");
    normals.clear();
  } else if (normals.size() != segments.size() + 1) {
    fail(p.where("N"), "a ribbon of {} segments takes {} values of \"N\", {} given", segments.size(),
         segments.size() + 1, normals.size());
  }
  for (Vec3& normal : normals) {
    normal = normalize_any(normal);
    if (normal == Vec3{}) fail(p.where("N"), "a normal has a direction, 0 0 0 was given");
  }
  const double width = p.real("width");
  const Vec2 widths{float(p.given("width0") ? p.real("width0") : width),
                    float(p.given("width1") ? p.real("width1") : width)};
  return std::vector<ShapeGeometry>{
      std::make_shared<const Curves>(std::move(segments), widths, kind, std::move(normals), placement)};
}

}  // namespace

extern const ShapeInfo curve_shape{
    {"shape", "curve", "A strip along a curve: a blade of grass, a hair, a stem.", "pbrt-v4", kCurve}, make_curve};

}  // namespace frond
