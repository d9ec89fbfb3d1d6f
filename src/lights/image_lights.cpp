#include "core/emission.h"
#include "core/error.h"
#include "core/light.h"
#include "core/math/direction_map.h"
#include "core/math/equal_area.h"
#include "core/math/vec.h"
#include "core/stop.h"
#include "lights/light_image.h"
#include "lights/light_params.h"
#include "spectra/cie.h"

namespace frond {
namespace {

/// Point light whose intensity an image specifies by direction.
class ImagePointLight : public Light, public EmissionSampler {
 public:
  explicit ImagePointLight(const Transform& world_from_light)
      : directions_(world_from_light), position_(world_from_light.point({})) {}
  /// A point within kLeastSquare of the light receives nothing, because the division would overflow.
  std::optional<LightSample> sample(const Vec3& p, Vec2, const SampledWavelengths& lambda) const override {
    const Vec3 d = position_ - p;
    const float distance2 = dot(d, d), distance = std::sqrt(distance2);
    if (distance2 < kLeastSquare) return {};
    const Vec3 wi = d / distance;
    const SampledSpectrum along = intensity(directions_.to_light(-wi), lambda);
    if (along.is_black()) return {};
    return LightSample{along * (1 / distance2), wi, distance, 1};
  }
  bool is_delta() const override { return true; }
  /// Directions are uniform over the sphere.
  std::optional<EmittedRay> sample_emission(Vec2, Vec2 u, const SampledWavelengths& lambda) const override {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
    const Vec3 w{r * std::cos(phi), r * std::sin(phi), z};
    const SampledSpectrum along = intensity(directions_.to_light(w), lambda);
    if (along.is_black()) return {};
    return EmittedRay{position_, w, along * (4 * kPi)};
  }
  std::optional<LightBounds> bounds() const override { return LightBounds{.min = position_, .max = position_}; }

 protected:
  /// Returns the intensity along a unit direction of the light's space.
  virtual SampledSpectrum intensity(const Vec3& w, const SampledWavelengths& lambda) const = 0;
  const DirectionMap& directions() const { return directions_; }

 private:
  DirectionMap directions_;
  Vec3 position_;
};

/// Projects an image from a point along +z, upright, with x to the right.
class ProjectionLight final : public ImagePointLight {
 public:
  ProjectionLight(const Params& p, const Transform& world_from_light)
      : ImagePointLight(world_from_light), image_(read_light_image(p)) {
    const float aspect = float(image_.width()) / float(image_.height());
    const auto tangent = float(std::tan(p.real("fov") * kPiD / 360));
    half_width_ = tangent * std::max(aspect, 1.f), half_height_ = tangent * std::max(1 / aspect, 1.f);
    flux_ = flux();
    scale_ = light_scale(p, "power", flux_);
    axis_ = directions().to_world({0, 0, 1});
    cos_corner_ = 1;
    for (const float x : {-half_width_, half_width_})
      for (const float y : {-half_height_, half_height_})
        cos_corner_ = std::min(cos_corner_, dot(axis_, directions().to_world(normalize_any(Vec3{x, y, 1}))));
  }
  double power(float) const override { return double(scale_) * flux_; }
  std::optional<LightBounds> bounds() const override {
    LightBounds bounds = *ImagePointLight::bounds();
    // Bounds of a cone around the whole image; the margin covers rounding at its edge.
    bounds.axis = axis_, bounds.cos_spread = std::max(-1.f, cos_corner_), bounds.cos_reach = 1 - 0x1p-10f;
    return bounds;
  }
  const Spectrum& emission() const override { return *image_.white(); }

 private:
  /// Returns 0 outside of the image.
  SampledSpectrum intensity(const Vec3& w, const SampledWavelengths& lambda) const override {
    if (!(w.z > 0)) return {};
    const Vec2 uv{(w.x / (w.z * half_width_) + 1) / 2, (1 - w.y / (w.z * half_height_)) / 2};
    if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return {};
    return image_.nearest(uv, lambda) * scale_;
  }
  /// Photometric flux; texels are constant over their solid angles.
  double flux() const {
    const int width = image_.width(), height = image_.height();
    double sum = 0;
    StopPoll poll;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        poll();
        const double x = ((2 * i + 1.0) / width - 1) * double(half_width_);
        const double y = ((2 * j + 1.0) / height - 1) * double(half_height_);
        const double spread = double(directions().solid_angle_factor(to_float(normalize(Vec3d{x, y, 1}))));
        sum += double(image_.luminances()[size_t(j) * size_t(width) + size_t(i)]) * spread *
               std::pow(1 + x * x + y * y, -1.5);
      }
    return sum * 4 * double(half_width_) * double(half_height_) / (double(width) * height);
  }

  LightImage image_;
  float half_width_ = 0, half_height_ = 0;  ///< of the image at z = 1
  double flux_ = 0;
  float scale_ = 0, cos_corner_ = 0;
  Vec3 axis_;
};

/// A spectrum times the grey value of an image over the sphere, whose pole is +y.
class GoniometricLight final : public ImagePointLight {
 public:
  GoniometricLight(const Params& p, const Transform& world_from_light)
      : ImagePointLight(world_from_light), spectrum_(p.spectrum("I")) {
    const Image image = read_light_image(p).image;
    if (image.width != image.height)
      fail(p.where("filename"),
           "the image is {} x {}: a square one is needed, in pbrt-v4's equal-area map of the sphere", image.width,
           image.height);
    size_ = image.width;
    double sum = 0;
    StopPoll poll;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
      poll();
      const int cell = int(texels_.size());
      const Vec2 centre{(float(cell % size_) + 0.5f) / float(size_), (float(cell / size_) + 0.5f) / float(size_)};
      const Vec3 w = sphere_from_square(centre);
      texels_.push_back((image.pixels[i] + image.pixels[i + 1] + image.pixels[i + 2]) / 3);
      sum += double(texels_.back() * directions().solid_angle_factor({w.x, w.z, w.y}));
    }
    steradians_ = 4 * kPiD * sum / double(texels_.size());
    scale_ = lamp_scale(p, *spectrum_, steradians_, steradians_);
  }
  double power(float) const override { return photometric(*spectrum_) * double(scale_) * steradians_; }
  const Spectrum& emission() const override { return *spectrum_; }

 private:
  /// y and z are exchanged, as in pbrt-v4.
  SampledSpectrum intensity(const Vec3& w, const SampledWavelengths& lambda) const override {
    const Vec2 uv = square_from_sphere({w.x, w.z, w.y});
    const auto cell = [this](float t) { return size_t(std::clamp(int(t * float(size_)), 0, size_ - 1)); };
    return spectrum_->sample(lambda) * (scale_ * texels_[cell(uv.y) * size_t(size_) + cell(uv.x)]);
  }

  SpectrumPtr spectrum_;
  int size_;
  std::vector<float> texels_;
  double steradians_;  ///< integral of the texels over solid angle, sr
  float scale_;
};

constexpr Param kProjection[] = {{.name = "filename",
                                  .kind = ParamKind::string,
                                  .doc = "Image; \"fov\" is the angle of its shorter side.",
                                  .required = true},
                                 {.name = "fov",
                                  .kind = ParamKind::real,
                                  .default_value = 90.0,
                                  .unit = "degrees",
                                  .range = {1e-3, 179.999},
                                  .doc = "Angle of the image's shorter side."},
                                 kLightPower,
                                 kLightScale};
constexpr Param kGoniometric[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Square image in pbrt-v4's equal-area map, with y and z exchanged; the mean of its channels is used.",
     .required = true},
    {.name = "I",
     .kind = ParamKind::illuminant,
     .default_value = std::array<double, 3>{1, 1, 1},
     .doc = "Radiant intensity, multiplied by the image; spectra are normalised to luminance 1."},
    kLightPower,
    kRadiantPower,
    kPhotonFlux,
    kLightScale};

}  // namespace

extern const LightInfo projection_light{
    {"light", "projection", "Projector: an image projected along +z.", "pbrt-v4", kProjection},
    make_light<ProjectionLight>};
extern const LightInfo goniometric_light{
    {"light", "goniometric", "Point light with an image of its intensity over directions.", "pbrt-v4", kGoniometric},
    make_light<GoniometricLight>};

}  // namespace frond
