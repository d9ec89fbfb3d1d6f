#include <cmath>

#include "core/emission.h"
#include "core/error.h"
#include "core/light.h"
#include "core/math/sampling.h"
#include "core/math/vec.h"
#include "core/world.h"
#include "lights/light_image.h"
#include "lights/light_params.h"
#include "spectra/cie.h"

namespace frond {
namespace {

/// Returns the direction of a light with "from" and "to", with the transform that pbrt composes.
Vec3 direction_of(const Params& p, const Transform& world_from_light) {
  const Vec3 from = p.vec3("from"), to = p.vec3("to");
  if (from == to) fail(p.where("to"), "\"from\" and \"to\" are the same point: the light has no direction");
  return normalize_any(world_from_light.vector(normalize_any(to - from)));
}

/// Returns a direction uniform in the cone around an axis; 1 - cosine of its half angle is `height`.
Vec3 sample_cone(const Vec3& axis, float height, Vec2 u) {
  const float z = 1 - u.x * height, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
  return Frame::around(axis).to_world({r * std::cos(phi), r * std::sin(phi), z});
}

/// Parallel light. Its illuminance on a facing surface equals the radiance parameter.
class DistantLight final : public Light {
 public:
  DistantLight(const Params& p, const Transform& world_from_light)
      : spectrum_(p.spectrum("L")), scale_(light_scale(p, "illuminance", 1)), wi_(-direction_of(p, world_from_light)) {}
  std::optional<LightSample> sample(const Vec3&, Vec2, const SampledWavelengths& lambda) const override {
    return LightSample{spectrum_->sample(lambda) * scale_, wi_, INFINITY, 1};
  }
  bool is_delta() const override { return true; }
  bool is_distant() const override { return true; }
  /// Power through a disk of the scene's radius.
  double power(float r) const override {
    return photometric(*spectrum_) * double(scale_) * kPiD * double(r) * double(r);
  }
  const Spectrum& emission() const override { return *spectrum_; }

 private:
  SpectrumPtr spectrum_;
  float scale_;
  Vec3 wi_;
};

/// Uniform intensity; the total power is 4 pi times the intensity.
class PointLight final : public Light, public EmissionSampler {
 public:
  PointLight(const Params& p, const Transform& world_from_light)
      : spectrum_(p.spectrum("I")),
        scale_(lamp_scale(p, *spectrum_, 4 * kPiD, 4 * kPiD)),
        position_(world_from_light.point(p.vec3("from"))) {}
  /// A point within kLeastSquare of the light receives nothing, because the division would overflow.
  std::optional<LightSample> sample(const Vec3& p, Vec2, const SampledWavelengths& lambda) const override {
    const Vec3 d = position_ - p;
    const float distance2 = dot(d, d), distance = std::sqrt(distance2);
    if (distance2 < kLeastSquare) return {};
    return LightSample{spectrum_->sample(lambda) * (scale_ / distance2), d / distance, distance, 1};
  }
  bool is_delta() const override { return true; }
  double power(float) const override { return photometric(*spectrum_) * double(scale_) * 4 * kPiD; }
  std::optional<LightBounds> bounds() const override { return LightBounds{.min = position_, .max = position_}; }
  const Spectrum& emission() const override { return *spectrum_; }
  std::optional<EmittedRay> sample_emission(Vec2, Vec2 u, const SampledWavelengths& lambda) const override {
    return EmittedRay{position_, sample_cone({0, 0, 1}, 2, u), spectrum_->sample(lambda) * (scale_ * 4 * kPi)};
  }

 private:
  SpectrumPtr spectrum_;
  float scale_;
  Vec3 position_;
};

/// Full intensity inside the inner cone, 0 outside the outer cone, and a smoothstep of the cosine between.
class SpotLight final : public Light, public EmissionSampler {
 public:
  SpotLight(const Params& p, const Transform& world_from_light)
      : spectrum_(p.spectrum("I")),
        position_(world_from_light.point(p.vec3("from"))),
        axis_(direction_of(p, world_from_light)) {
    const double cone = p.real("coneangle"), delta = p.real("conedeltaangle");
    if (delta > cone)
      fail(p.where("conedeltaangle"), "\"conedeltaangle\" {} is more than \"coneangle\" {}", delta, cone);
    cos_outer_ = float(std::cos(cone * kPiD / 180));
    if (!(cos_outer_ < 1)) fail(p.where("coneangle"), "a \"coneangle\" of {} degrees lets no light through", cone);
    cos_inner_ = float(std::cos((cone - delta) * kPiD / 180));
    scale_ = lamp_scale(p, *spectrum_, solid_angle(), solid_angle());
  }
  /// Returns nullopt outside of the cone.
  std::optional<LightSample> sample(const Vec3& p, Vec2, const SampledWavelengths& lambda) const override {
    const Vec3 d = position_ - p;
    const float distance2 = dot(d, d), distance = std::sqrt(distance2);
    if (distance2 < kLeastSquare) return {};
    const float falloff = intensity(-dot(d, axis_) / distance);
    if (falloff == 0) return {};
    return LightSample{spectrum_->sample(lambda) * (scale_ * falloff / distance2), d / distance, distance, 1};
  }
  bool is_delta() const override { return true; }
  double power(float) const override { return photometric(*spectrum_) * double(scale_) * solid_angle(); }
  std::optional<LightBounds> bounds() const override {
    // Bounds of the cone; the margin covers rounding at its edge.
    return LightBounds{
        .min = position_, .max = position_, .axis = axis_, .cos_spread = cos_outer_, .cos_reach = 1 - 0x1p-10f};
  }
  const Spectrum& emission() const override { return *spectrum_; }
  std::optional<EmittedRay> sample_emission(Vec2, Vec2 u, const SampledWavelengths& lambda) const override {
    const Vec3 w = sample_cone(axis_, 1 - cos_outer_, u);
    const float factor = scale_ * intensity(dot(w, axis_)) * 2 * kPi * (1 - cos_outer_);
    return EmittedRay{position_, w, spectrum_->sample(lambda) * factor};
  }

 private:
  double solid_angle() const { return 2 * kPiD * ((1 - double(cos_inner_)) + double(cos_inner_ - cos_outer_) / 2); }
  /// Relative intensity at an angle from the axis.
  float intensity(float cos_theta) const {
    if (cos_theta <= cos_outer_) return 0;
    if (cos_theta >= cos_inner_) return 1;
    const float t = (cos_theta - cos_outer_) / (cos_inner_ - cos_outer_);
    return t * t * (3 - 2 * t);
  }

  SpectrumPtr spectrum_;
  Vec3 position_, axis_;
  float cos_outer_, cos_inner_, scale_;
};

/// Properties that all lights of one AreaLightSource directive share.
struct DiffuseEmission {
  SpectrumPtr spectrum;
  std::optional<LightImage> image;  ///< over (u, v), instead of uniform radiance
  double mean = 1;                  ///< mean luminance of the image
  double luminance = 0;             ///< mean luminance of the unscaled emission
  double scale = 1;
  std::optional<double> power;     ///< of each light
  std::optional<double> spectral;  ///< spectral power of each light over `spectrum`
  bool two_sided = false;
  Location where;

  explicit DiffuseEmission(const Params& p)
      : scale(p.real("scale")), power(stated_total(p, "power")), two_sided(p.boolean("twosided")), where(p.where()) {
    if (p.given("filename")) {
      if (p.given("L")) fail(p.where("L"), "\"L\" and \"filename\" exclude each other");
      image.emplace(read_light_image(p));
      spectrum = image->white();
      mean = image->mean_luminance();
      if (power && !(mean > 0)) fail(p.where("power"), "the image is black: it has no power to scale");
    } else {
      spectrum = p.spectrum("L");
    }
    luminance = photometric(*spectrum) * mean;
    spectral = stated_power(p, *spectrum);
    if (spectral && image) fail(where, "\"radiantpower\" and \"photonflux\" need a spectrum \"L\", not an image");
  }
  double sides() const { return two_sided ? 2 : 1; }
};

/// Emits the same radiance from all points of a surface, or the radiance of an image over (u, v).
class DiffuseAreaLight final : public AreaLight, public EmissionSampler {
 public:
  DiffuseAreaLight(std::shared_ptr<const DiffuseEmission> emission, std::unique_ptr<const EmittingSurface> surface)
      : emission_(std::move(emission)), surface_(std::move(surface)), area_(float(surface_->area())) {
    if (!(surface_->area() > 0))
      fail(emission_->where, "an area light needs a surface with an area, this one has {}", surface_->area());
    scale_ = float(emission_->scale);
    if (emission_->power)
      scale_ = float(emission_->scale * *emission_->power /
                     (emission_->sides() * kPiD * surface_->area() * emission_->mean));
    if (emission_->spectral)
      scale_ = float(emission_->scale * *emission_->spectral / (emission_->sides() * kPiD * surface_->area()));
  }
  /// Samples the surface by area.
  std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const override {
    const auto [on_light, uv, weight] = surface_->sample(u);
    const Vec3 d = on_light.p - p;
    const float distance = length(d);
    if (distance == 0) return {};
    const Vec3 wi = d / distance;
    const EmittingPoint at{on_light.p, on_light.ng, uv};
    const float density = pdf_along(at.ng, wi, distance);
    // `pdf` assumes that points are uniform over the area; the weight corrects the radiance for the actual density.
    const SampledSpectrum emitted = radiance(at, -wi, lambda) * weight;
    if (!std::isfinite(density) || emitted.is_black()) return {};
    return LightSample{emitted, wi, distance, density};
  }
  /// The opacity accounts for surfaces with alpha below 1.
  SampledSpectrum radiance(const EmittingPoint& at, const Vec3& w, const SampledWavelengths& lambda) const override {
    if (!emission_->two_sided && !(dot(at.ng, w) > 0)) return {};
    const SampledSpectrum emitted = emission_->image ? emission_->image->bilinear({at.uv.x, 1 - at.uv.y}, lambda)
                                                     : emission_->spectrum->sample(lambda);
    return emitted * (scale_ * surface_->opacity(at));
  }
  float pdf(const Vec3& from, const EmittingPoint& at) const override {
    const Vec3 d = at.p - from;
    const float density = pdf_along(at.ng, normalize_any(d), length(d));
    return density > 0 ? density : 0;  // NaN if both points coincide
  }
  bool is_delta() const override { return !surface_->is_intersectable(); }
  /// Diffuse emission: pi times radiance times area, for each emitting side.
  double power(float) const override {
    return emission_->luminance * double(scale_) * kPiD * surface_->area() * emission_->sides();
  }
  std::optional<LightBounds> bounds() const override {
    LightBounds bounds = surface_->bounds();
    bounds.two_sided = emission_->two_sided;
    return bounds;
  }
  const Spectrum& emission() const override { return *emission_->spectrum; }
  std::optional<EmittedRay> sample_emission(Vec2 point, Vec2 u, const SampledWavelengths& lambda) const override {
    const auto [on_light, uv, weight] = surface_->sample(point);
    const auto sides = float(emission_->sides());
    const bool is_back = emission_->two_sided && u.x >= 0.5f;
    if (emission_->two_sided) u.x = is_back ? 2 * u.x - 1 : 2 * u.x;
    const Vec3 w = Frame::around(is_back ? -on_light.ng : on_light.ng).to_world(sample_cosine_hemisphere(u));
    const SampledSpectrum emitted = radiance({on_light.p, on_light.ng, uv}, w, lambda);
    if (emitted.is_black()) return {};
    const Vec3& p = on_light.p;
    Hit hit{};
    hit.p = p, hit.ng = on_light.ng, hit.extent = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return EmittedRay{offset_origin(hit, w), w, emitted * (weight * sides * kPi * area_)};
  }

 private:
  /// Converts the density over area to solid angle.
  float pdf_along(const Vec3& ng, const Vec3& wi, float distance) const {
    return distance * distance / (std::abs(dot(ng, wi)) * area_);
  }

  std::shared_ptr<const DiffuseEmission> emission_;
  std::unique_ptr<const EmittingSurface> surface_;
  float area_;
  float scale_ = 0;
};

/// Creates the lights of all shapes of a directive, which share spectrum and image.
class DiffuseAreaEmission final : public AreaEmission {
 public:
  explicit DiffuseAreaEmission(const Params& p) : emission_(std::make_shared<const DiffuseEmission>(p)) {}
  bool is_by_face() const override { return emission_->power.has_value(); }
  std::unique_ptr<AreaLight> make_area_light(std::unique_ptr<const EmittingSurface> surface) const override {
    return std::make_unique<DiffuseAreaLight>(emission_, std::move(surface));
  }

 private:
  std::shared_ptr<const DiffuseEmission> emission_;
};

constexpr Default kWhite = std::array<double, 3>{1, 1, 1};
constexpr Param kRadiance{.name = "L",
                          .kind = ParamKind::illuminant,
                          .default_value = kWhite,
                          .doc = "Emitted radiance; spectra are normalised to luminance 1."};
constexpr Param kIntensity{.name = "I",
                           .kind = ParamKind::illuminant,
                           .default_value = kWhite,
                           .doc = "Radiant intensity; spectra are normalised to luminance 1."};
constexpr Param kFrom{
    .name = "from", .kind = ParamKind::point3, .default_value = std::array<double, 3>{0, 0, 0}, .doc = "Position."};
constexpr Param kTo{.name = "to",
                    .kind = ParamKind::point3,
                    .default_value = std::array<double, 3>{0, 0, 1},
                    .doc = "Point that the light is directed at."};
constexpr Param kDistant[] = {
    kRadiance,
    kLightScale,
    kFrom,
    kTo,
    {.name = "illuminance",
     .kind = ParamKind::real,
     .unit = "lx",
     .doc = "Illuminance of a surface that faces the light, to which the light is scaled; 0 or less: not given."}};
constexpr Param kPoint[] = {kIntensity, kLightScale, kLightPower, kRadiantPower, kPhotonFlux, kFrom};
constexpr Param kSpot[] = {kIntensity,
                           kLightScale,
                           kLightPower,
                           kRadiantPower,
                           kPhotonFlux,
                           kFrom,
                           kTo,
                           {.name = "coneangle",
                            .kind = ParamKind::real,
                            .default_value = 30.0,
                            .unit = "degrees",
                            .range = {1e-3, 180},
                            .doc = "Angle between the axis and the cone's edge.",
                            .quantity = PhysicalQuantity::angle},
                           {.name = "conedeltaangle",
                            .kind = ParamKind::real,
                            .default_value = 5.0,
                            .unit = "degrees",
                            .range = {0, 180},
                            .doc = "Width of the smooth transition at the edge."}};
constexpr Param kDiffuseArea[] = {
    kRadiance,
    {.name = "filename", .kind = ParamKind::string, .doc = "Image over (u, v), top at v = 1, instead of L."},
    kLightScale,
    kLightPower,
    kRadiantPower,
    kPhotonFlux,
    {.name = "twosided", .kind = ParamKind::boolean, .default_value = false, .doc = "Emit from both sides."}};

std::unique_ptr<AreaEmission> make_diffuse_area(const Params& p) { return std::make_unique<DiffuseAreaEmission>(p); }

}  // namespace

extern const LightInfo distant_light{{"light", "distant", "Directional light.", "pbrt-v4", kDistant},
                                     make_light<DistantLight>};
extern const LightInfo point_light{
    {"light", "point", "Point light with the same intensity in every direction.", "pbrt-v4", kPoint},
    make_light<PointLight>};
extern const LightInfo spot_light{{"light", "spot", "Spotlight: a cone with a smooth edge.", "pbrt-v4", kSpot},
                                  make_light<SpotLight>};
extern const AreaLightInfo diffuse_area_light{
    {"area light", "diffuse", "Area light with the same radiance in every direction.", "pbrt-v4", kDiffuseArea},
    make_diffuse_area};

}  // namespace frond
