#include "lights/portal_light.h"

#include <numbers>

#include "core/error.h"
#include "core/math/distribution.h"
#include "core/math/equal_area.h"
#include "core/stop.h"
#include "lights/light_params.h"
#include "lights/sphere_image.h"
#include "spectra/cie.h"

namespace frond {
namespace {

/// A rectangle through which light from outside enters, opposite to its axis. Visible directions are a window of the
/// square of the angles along its sides (Bitterli et al. 2015, "Portal-Masked Environment Map Sampling").
class Portal {
 public:
  /// Throws InputError unless the corners form a rectangle, to pbrt-v4's tolerance.
  explicit Portal(const Params& p) {
    const std::vector<Vec3> corners = p.vec3s("portal");
    const Location where = p.where("portal");
    if (corners.size() != 4) fail(where, "\"portal\" takes 4 points, {} given", corners.size());
    const Vec3 right = corners[3] - corners[0], up = corners[1] - corners[0];
    const Vec3 x = normalize_any(right), y = normalize_any(up);
    const Vec3 far_x = normalize_any(corners[2] - corners[1]), far_y = normalize_any(corners[2] - corners[3]);
    constexpr float kTolerance = 1e-3f;  // pbrt-v4's
    if (!(std::abs(dot(x, far_x) - 1) < kTolerance && std::abs(dot(y, far_y) - 1) < kTolerance &&
          std::abs(dot(x, y)) < kTolerance && std::abs(dot(far_x, far_y)) < kTolerance))
      fail(where, "\"portal\" is not a rectangle with corners in cyclic order");
    first_ = corners[0], opposite_ = corners[2];
    frame_ = {x, y, normalize_any(cross(x, y))};
    area_ = length(to_double(right)) * length(to_double(up));
  }

  struct Direction {
    Vec3 w;            ///< unit, world space
    float steradians;  ///< per unit area of the square
  };
  /// Returns the coordinates of a direction on the outer side; nullopt on the inner side.
  std::optional<Vec2> to_square(const Vec3& w, float* steradians = nullptr) const {
    const Vec3 d = frame_.to_local(w);
    if (!(d.z > 0)) return {};
    if (steradians) *steradians = jacobian(d);
    const auto at = [&](float t) { return std::clamp(std::atan2(t, d.z) * kInvPi + 0.5f, 0.f, 1.f); };
    return Vec2{at(d.x), at(d.y)};
  }
  /// Inverse of square_of. The square's axes are angles, which spread directions more evenly than tangents.
  Direction direction_of(Vec2 uv) const {
    const auto tangent = [](float t) { return std::tan((t - 0.5f) * kPi); };
    const Vec3 d = normalize_any(Vec3{tangent(uv.x), tangent(uv.y), 1});
    return {frame_.to_world(d), jacobian(d)};
  }
  /// Returns the window visible from a point; nullopt behind the portal.
  std::optional<WindowedDistribution::Window> window_at(const Vec3& from) const {
    const auto a = to_square(normalize_any(first_ - from)), b = to_square(normalize_any(opposite_ - from));
    if (!a || !b) return {};
    return WindowedDistribution::Window{{std::min(a->x, b->x), std::min(a->y, b->y)},
                                        {std::max(a->x, b->x), std::max(a->y, b->y)}};
  }
  double area() const { return area_; }
  float cosine(const Vec3& w) const { return dot(frame_.z, w); }

 private:
  static float jacobian(const Vec3& d) { return kPi * kPi * (1 - d.x * d.x) * (1 - d.y * d.y) / d.z; }

  Frame frame_;
  Vec3 first_, opposite_;
  double area_ = 0;
};

/// An environment visible only through a portal.
class PortalEnvironment final : public EnvironmentLight {
 public:
  PortalEnvironment(const Params& p, float scale)
      : portal_(p), spectrum_(p.spectrum("L")), scale_(scale), directions_(weights(kEvenCells), kEvenCells) {
    flux_ = std::numbers::pi * photometric(*spectrum_);
  }
  PortalEnvironment(const Params& p, const Transform& world_from_light)
      : PortalEnvironment(p, world_from_light, read_sphere_image(p)) {}

  /// Samples the visible window by luminance and solid angle.
  std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const override {
    const auto window = portal_.window_at(p);
    if (!window) return {};
    const auto s = directions_.sample(u, *window);
    if (!s) return {};
    const auto [w, steradians] = portal_.direction_of(s->uv);
    const float density = s->pdf / steradians;
    if (!(density > 0 && std::isfinite(density))) return {};
    return LightSample{at(s->uv, lambda), w, INFINITY, density};
  }
  /// Returns 0 for directions that miss the portal.
  SampledSpectrum radiance(const Vec3& from, const Vec3& direction, const SampledWavelengths& lambda) const override {
    const auto uv = portal_.to_square(direction);
    const auto window = uv ? portal_.window_at(from) : std::nullopt;
    return window && window->contains(*uv) ? at(*uv, lambda) : SampledSpectrum();
  }
  float pdf(const Vec3& from, const Vec3& direction) const override {
    float steradians = 0;
    const auto uv = portal_.to_square(direction, &steradians);
    const auto window = uv ? portal_.window_at(from) : std::nullopt;
    const float density = window ? directions_.pdf(*uv, *window) / steradians : 0;
    return density > 0 && std::isfinite(density) ? density : 0;
  }
  bool is_delta() const override { return false; }
  /// The visible part of the environment depends on the position.
  bool is_distant() const override { return false; }
  double power(float) const override { return double(scale_) * portal_.area() * flux_; }
  const Spectrum& emission() const override { return image_ ? *image_->white() : *spectrum_; }

 private:
  static constexpr int kEvenCells = 64;

  PortalEnvironment(const Params& p, const Transform& world_from_light, const ColorImage& file)
      : portal_(p),
        image_(rectified(file, world_from_light.inverse())),
        scale_(sphere_image_scale(p, file)),
        directions_(weights(image_->width()), image_->width()) {
    const int n = image_->width();
    StopPoll poll;
    for (int i = 0; i < n * n; ++i) {
      poll();
      const auto [w, steradians] = portal_.direction_of(center(i, n));
      flux_ += double(image_->luminances()[size_t(i)] * steradians * portal_.cosine(w)) / (double(n) * n);
    }
  }

  static Vec2 center(int i, int n) { return {(float(i % n) + 0.5f) / float(n), (float(i / n) + 0.5f) / float(n)}; }

  /// Resamples the image's outer half by the portal's angles, at the same resolution.
  LightImage rectified(const ColorImage& file, const Transform& light_from_world) const {
    const int n = file.image.width;
    Image result(n, n, {"R", "G", "B"});
    const auto texel = [&](int x, int y, size_t c) {
      if (x < 0 || x >= n) x = x < 0 ? -1 - x : 2 * n - 1 - x, y = n - 1 - y;
      if (y < 0 || y >= n) y = y < 0 ? -1 - y : 2 * n - 1 - y, x = n - 1 - x;
      return file.image.at(x, y, c);
    };
    StopPoll poll;
    for (int i = 0; i < n * n; ++i) {
      poll();
      const Vec2 uv = square_from_sphere(normalize_any(light_from_world.vector(portal_.direction_of(center(i, n)).w)));
      const float x = uv.x * float(n) - 0.5f, y = uv.y * float(n) - 0.5f;
      const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
      const int a = int(x0), b = int(y0);
      for (size_t c = 0; c < 3; ++c)
        result.pixels[size_t(i) * 3 + c] = std::lerp(std::lerp(texel(a, b, c), texel(a + 1, b, c), fx),
                                                     std::lerp(texel(a, b + 1, c), texel(a + 1, b + 1, c), fx), fy);
    }
    return LightImage({std::move(result), file.space});
  }
  /// Weights of cells: luminance times solid angle at the centre.
  std::vector<float> weights(int n) const {
    std::vector<float> result;
    for (int i = 0; i < n * n; ++i)
      result.push_back(portal_.direction_of(center(i, n)).steradians * (image_ ? image_->luminances()[size_t(i)] : 1));
    return result;
  }
  SampledSpectrum at(Vec2 uv, const SampledWavelengths& lambda) const {
    return (image_ ? image_->nearest(uv, lambda) : spectrum_->sample(lambda)) * scale_;
  }

  Portal portal_;
  std::optional<LightImage> image_;
  SpectrumPtr spectrum_;
  float scale_;
  WindowedDistribution directions_;
  double flux_ = 0;  ///< per unit area of the portal
};

}  // namespace

/// A uniform environment needs no image.
std::unique_ptr<Light> make_portal_light(const Params& p, const Transform& world_from_light) {
  if (p.given("filename")) return std::make_unique<PortalEnvironment>(p, world_from_light);
  // pbrt-v4 treats this as an image of one texel centred on the pole; by its measure radiance 1 gives the illuminance 2
  // pi.
  const float scale = light_scale(p, "illuminance", 2 * std::numbers::pi);
  if (scale != float(p.real("scale")))
    p.warn("illuminance", "as in pbrt-v4, the radiance is half of what gives this illuminance without a portal");
  return std::make_unique<PortalEnvironment>(p, scale);
}

}  // namespace frond
