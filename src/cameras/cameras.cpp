#include <algorithm>
#include <numbers>

#include "core/camera.h"
#include "core/error.h"
#include "core/math/equal_area.h"
#include "core/math/float4.h"
#include "core/math/sampling.h"
#include "core/projection.h"

namespace frond {
namespace {

/// The part of the plane z = 1 that the film covers. As in pbrt, the shorter axis spans [-1, 1].
struct Screen {
  float x0, x1, y0, y1;  ///< bounds of the window; camera-space units for an orthographic camera
};

/// Returns the screen window of the parameters. A degenerate window is an error; one with too few values is ignored.
Screen screen_of(const Params& p, const CameraPlacement& film) {
  const float width = float(film.width), height = float(film.height);
  const float aspect = p.given("frameaspectratio") ? float(p.real("frameaspectratio")) : width / height;
  const auto window = p.reals("screenwindow");
  if (window.size() == 4) {
    if (window[0] == window[1] || window[2] == window[3]) fail(p.where("screenwindow"), "\"screenwindow\" is empty");
    return {float(window[0]), float(window[1]), float(window[2]), float(window[3])};
  }
  if (!window.empty())
    p.warn("screenwindow", fmt::format("\"screenwindow\" takes 4 values, {} given: it has no effect", window.size()));
  return aspect > 1 ? Screen{-aspect, aspect, -1, 1} : Screen{-1, 1, -1 / aspect, 1 / aspect};
}

/// Maps film pixels to screen coordinates, and models the thin lens of both projective cameras.
class ProjectiveCamera : public Camera, public Projection {
 public:
  /// `scale` is the factor of the screen window: tan(fov / 2) for a perspective camera, 1 for an orthographic one.
  ProjectiveCamera(const Params& p, const CameraPlacement& placement, float scale)
      : world_from_camera_(placement.world_from_camera),
        lens_radius_(float(p.real("lensradius"))),
        focal_distance_(float(p.real("focaldistance"))) {
    const Screen s = screen_of(p, placement);
    origin_ = {s.x0 * scale, s.y1 * scale};
    step_ = {(s.x1 - s.x0) * scale / float(placement.width), (s.y0 - s.y1) * scale / float(placement.height)};
  }

  /// False for a pinhole, of radius 0.
  bool uses_lens() const override { return lens_radius_ > 0; }

 protected:
  /// Returns the point of the plane z = 1 of a film position in pixels; y increases downward on the film.
  Vec2 screen_point(Vec2 film) const { return {origin_.x + film.x * step_.x, origin_.y + film.y * step_.y}; }
  /// Converts a camera-space ray to world space. A lens moves the origin within its disk; the point in focus is
  /// unchanged.
  Ray to_world(Vec3 o, Vec3 d, Vec2 lens) const {
    if (lens_radius_ > 0) {
      const Vec3 focus = o + d * (focal_distance_ / d.z);
      const Vec2 on_disk = sample_disk(lens);
      o += Vec3{on_disk.x * lens_radius_, on_disk.y * lens_radius_, 0};
      d = focus - o;
    }
    return {world_from_camera_.point(o), normalize_any(world_from_camera_.vector(normalize_any(d)))};
  }
  /// The same, of a camera without a lens, for four rays from the camera's position through points of the plane z = 1.
  /// Returns false if a length is extreme.
  bool to_world(Float4 x, Float4 y, Ray* to) const {
    Vec3x4 d{x, y, Float4{} + 1};
    if (!normalize(d)) return false;
    const auto& rows = world_from_camera_.rows();
    const auto row = [&](size_t i) { return rows[i][0] * d.x + rows[i][1] * d.y + rows[i][2] * d.z; };
    d = {row(0), row(1), row(2)};
    if (!normalize(d)) return false;
    const Vec3 o = world_from_camera_.point({});
    for (int i = 0; i < 4; ++i) ::new (to + i) Ray{o, {d.x[i], d.y[i], d.z[i]}};
    return true;
  }
  /// As screen_point, of four film positions at once: the x coordinates.
  Float4 screen_x(const Vec2* film) const {
    return origin_.x + Float4{film[0].x, film[1].x, film[2].x, film[3].x} * step_.x;
  }
  /// As screen_x: the y coordinates.
  Float4 screen_y(const Vec2* film) const {
    return origin_.y + Float4{film[0].y, film[1].y, film[2].y, film[3].y} * step_.y;
  }

 private:
  using Vec3x4 = Vec3T<Float4>;

  /// As normalize_any; returns false where that takes its slow path.
  static bool normalize(Vec3x4& v) {
    const Float4 square = dot(v, v);
    const auto is_moderate = (square > 1e-30f) & (square < 1e30f);
    if (!(is_moderate[0] & is_moderate[1] & is_moderate[2] & is_moderate[3])) return false;
    v = v * (1 / square_root(square));
    return true;
  }

  Transform world_from_camera_;
  Vec2 origin_, step_;  ///< screen point of the film's upper left corner; change from one pixel to the next
  float lens_radius_, focal_distance_;  ///< camera-space units; the distance is measured along z
};

/// Pinhole or thin-lens camera. "fov" is the angle of the shorter axis.
class PerspectiveCamera final : public ProjectiveCamera {
 public:
  PerspectiveCamera(const Params& p, const CameraPlacement& film)
      : ProjectiveCamera(p, film, float(scale_of(p))), scale_(scale_of(p)) {}
  Ray ray(Vec2 film, Vec2 lens) const override {
    const Vec2 s = screen_point(film);
    return to_world({0, 0, 0}, {s.x, s.y, 1}, lens);
  }
  /// Generates four rays at a time for a pinhole, with the same bits as `ray`; a lens, the remainder and extreme
  /// directions use the scalar path.
  void rays(const Vec2* film, const Vec2* lens, int count, Ray* to) const override {
    int i = 0;
    for (; i + 4 <= count && !uses_lens(); i += 4)
      if (!to_world(screen_x(film + i), screen_y(film + i), to + i)) break;
    Camera::rays(film + i, lens + i, count - i, to + i);
  }
  Matrix screen_from_camera() const override {
    constexpr double kNear = 0.01, kFar = 1000;  // planes of pbrt-v4, camera-space units
    const double z = kFar / (kFar - kNear);
    return {{{1 / scale_, 0, 0, 0}, {0, 1 / scale_, 0, 0}, {0, 0, z, -kNear * z}, {0, 0, 1, 0}}};
  }

 private:
  static double scale_of(const Params& p) { return std::tan(p.real("fov") * std::numbers::pi / 360); }

  double scale_;  ///< half of the width of the plane z = 1 along the shorter axis
};

/// Parallel projection along +z. The screen window is in camera-space units.
class OrthographicCamera final : public ProjectiveCamera {
 public:
  OrthographicCamera(const Params& p, const CameraPlacement& film) : ProjectiveCamera(p, film, 1) {}
  Ray ray(Vec2 film, Vec2 lens) const override {
    const Vec2 s = screen_point(film);
    return to_world({s.x, s.y, 0}, {0, 0, 1}, lens);
  }
  /// The near plane is z = 0 and the far plane z = 1, as in pbrt-v4.
  Matrix screen_from_camera() const override { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}; }
};

/// Names of "mapping": the octahedral map of Clarberg 2008, which preserves area (pbrt 4th ed., 3.8.3), and
/// latitude-longitude.
constexpr std::string_view kMappings[] = {"equalarea", "equirectangular"};

/// Camera for all directions around a point, with the zenith at +y.
class SphericalCamera final : public Camera {
 public:
  SphericalCamera(const Params& p, const CameraPlacement& film)
      : world_from_camera_(film.world_from_camera),
        width_(float(film.width)),
        height_(float(film.height)),
        equal_area_(p.string("mapping") == "equalarea") {
    for (const std::string_view name : {"frameaspectratio", "screenwindow", "lensradius", "focaldistance"})
      if (p.given(name)) p.warn(name, fmt::format("\"{}\" has no effect on a spherical camera", name));
  }
  /// All rays start at the camera's position, because a panorama has no lens.
  Ray ray(Vec2 film, Vec2) const override {
    const Vec2 uv{film.x / width_, film.y / height_};
    return {world_from_camera_.point({}), normalize_any(world_from_camera_.vector(direction(uv)))};
  }
  bool uses_lens() const override { return false; }

 private:
  /// Returns the camera-space direction of a point of the film, +y up, by either map of "mapping".
  Vec3 direction(Vec2 uv) const {
    if (equal_area_) {
      const Vec3 d = sphere_from_square(wrapped_on_square(uv));
      return {d.x, d.z, d.y};
    }
    const float theta = uv.y * kPi, phi = uv.x * 2 * kPi;
    return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
  }

  Transform world_from_camera_;
  float width_, height_;
  bool equal_area_;
};

constexpr Interval kDistances{1e-30, 1e30};
constexpr Param kFrameAspect{.name = "frameaspectratio",
                             .kind = ParamKind::real,
                             .range = {1e-3, 1e3},
                             .doc = "Aspect ratio, width over height; by default the film's."};
constexpr Param kScreenWindow{.name = "screenwindow",
                              .kind = ParamKind::real,
                              .doc = "Screen window x0 x1 y0 y1; by default the shorter axis spans -1 to 1.",
                              .list = true};
constexpr Param kLensRadius{.name = "lensradius",
                            .kind = ParamKind::real,
                            .default_value = 0.0,
                            .range = kAtLeastZero,
                            .doc = "Radius of the thin lens; 0: a pinhole."};
constexpr Param kFocalDistance{.name = "focaldistance",
                               .kind = ParamKind::real,
                               .default_value = 1e6,
                               .range = kDistances,
                               .doc = "Distance of the plane of focus."};
constexpr Param kShutterOpen{.name = "shutteropen",
                             .kind = ParamKind::real,
                             .default_value = 0.0,
                             .unit = "s",
                             .doc = "Start of the exposure; the duration of the exposure scales the image."};
constexpr Param kShutterClose{
    .name = "shutterclose", .kind = ParamKind::real, .default_value = 1.0, .unit = "s", .doc = "End of the exposure."};
constexpr Param kPerspective[] = {kFrameAspect,
                                  kScreenWindow,
                                  kLensRadius,
                                  kFocalDistance,
                                  kShutterOpen,
                                  kShutterClose,
                                  {.name = "fov",
                                   .kind = ParamKind::real,
                                   .default_value = 90.0,
                                   .unit = "degrees",
                                   .range = {1e-3, 179.999},
                                   .doc = "Field of view along the shorter axis."}};
constexpr Param kOrthographic[] = {kFrameAspect,   kScreenWindow, kLensRadius,
                                   kFocalDistance, kShutterOpen,  kShutterClose};
constexpr Param kSpherical[] = {{.name = "mapping",
                                 .kind = ParamKind::string,
                                 .default_value = std::string_view("equalarea"),
                                 .doc = "Map from the film to directions; equal-area requires a square film.",
                                 .choices = kMappings},
                                kFrameAspect,
                                kScreenWindow,
                                kLensRadius,
                                kFocalDistance,
                                kShutterOpen,
                                kShutterClose};

/// Checks the shutter times. The duration of the exposure scales the film.
void check_shutter(const Params& p) {
  const double open = p.real("shutteropen"), close = p.real("shutterclose");
  if (close < open) p.warn("shutterclose", "the shutter closes before it opens: the two are exchanged");
  if (close == open) p.warn("shutterclose", "the shutter is open for no time: the image is black");
}

/// Factory of a camera class T. Throws InputError for invalid parameters.
template <class T>
std::unique_ptr<Camera> make_camera(const Params& p, const CameraPlacement& film) {
  check_shutter(p);
  return std::make_unique<T>(p, film);
}

}  // namespace

extern const CameraInfo perspective_camera{{"camera", "perspective", "Pinhole or thin lens.", "pbrt-v4", kPerspective},
                                           make_camera<PerspectiveCamera>};
extern const CameraInfo spherical_camera{
    {"camera", "spherical", "Camera for all directions around a point.", "pbrt-v4", kSpherical},
    make_camera<SphericalCamera>};
extern const CameraInfo orthographic_camera{
    {"camera", "orthographic", "Parallel projection.", "pbrt-v4", kOrthographic}, make_camera<OrthographicCamera>};

}  // namespace frond
