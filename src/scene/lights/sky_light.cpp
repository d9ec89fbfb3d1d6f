#include <fmt/format.h>

#include <numbers>

#include "core/error.h"
#include "core/light.h"
#include "core/sampling.h"
#include "scene/lights/light_params.h"
#include "scene/lights/sky_shape.h"
#include "scene/math/direction_map.h"
#include "scene/math/distribution.h"
#include "scene/math/equal_area.h"
#include "spectra/cie.h"
#include "spectra/spectrl2.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

constexpr double kPiD = std::numbers::pi, kRadians = kPiD / 180;
constexpr double kSunRadius = 0.2666 * kRadians;  ///< at the mean distance
constexpr double kOvercastTransmission = 0.25;  ///< Kasten and Czeplak 1980, cloud cover 8/8: of the clear sky's global
constexpr int kCieOvercast = 1;                 ///< CIE standard overcast sky

/// Equal-area map from the unit square to the upper hemisphere: to the diamond that holds this half of
/// sphere_from_square's square.
Vec3 hemisphere_from_square(Vec2 uv) { return sphere_from_square({(uv.x + uv.y) / 2, (uv.x - uv.y + 1) / 2}); }
Vec2 square_from_hemisphere(const Vec3& d) {
  const Vec2 at = square_from_sphere(d);
  return {at.x + at.y - 0.5f, at.x - at.y + 0.5f};
}

/// The disc of the sun, of uniform radiance.
class SunDisc {
 public:
  /// `toward`: unit, world space; `radius`: angle, rad.
  SunDisc(const Vec3& toward, double radius)
      : frame_(Frame::around(toward)),
        sine_(float(std::sin(radius))),
        chord2_(float(4 * std::pow(std::sin(radius / 2), 2))),
        density_(float(1 / (2 * kPiD * (1 - std::cos(radius))))) {}

  const Vec3& toward() const { return frame_.z; }
  /// Returns whether a direction with this squared distance from the centre's unit vector is on the disc.
  bool contains(float distance2) const { return distance2 <= chord2_; }
  /// Samples the disc. The density over solid angle varies by 1e-5 and counts as constant.
  Vec3 sample(Vec2 u) const {
    const float r = sine_ * std::sqrt(u.x), phi = 2 * kPi * u.y;
    return normalize_any(frame_.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)}));
  }
  float density() const { return density_; }
  /// Projected solid angle on a plane that faces the sun: irradiance over radiance.
  double projected() const { return kPiD * double(sine_) * double(sine_); }

 private:
  Frame frame_;
  float sine_, chord2_, density_;
};

/// What the parameters say: spectra, angular distribution and sun of a sky. z is up.
struct SkyModel {
  Vec3d toward_sun;   ///< unit, light space
  double sun_radius;  ///< angle, rad
  bool is_overcast;
  std::vector<double> nm, direct_normal, diffuse;  ///< W m^-2 nm^-1; all 0 unless the sun is above the horizon
  SkyShape shape{};

  explicit SkyModel(const Params& p);
  bool is_black() const { return !(integral(nm, diffuse) > 0); }
  double sun_zenith_deg() const { return std::acos(std::clamp(toward_sun.z, -1.0, 1.0)) / kRadians; }
  /// Irradiance of the sun on a horizontal plane, W m^-2.
  double direct_total() const { return integral(nm, direct_normal) * std::max(0.0, toward_sun.z); }
  double diffuse_total() const { return integral(nm, diffuse); }
};

/// Returns the direction toward the sun. Throws InputError if "sundirection" is 0 or is given besides the angles.
Vec3d toward_sun(const Params& p) {
  if (!p.given("sundirection")) {
    const double elevation = p.real("elevation") * kRadians, azimuth = p.real("azimuth") * kRadians;
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }
  for (const char* angle : {"elevation", "azimuth"})
    if (p.given(angle)) fail(p.where(angle), "\"{}\" and \"sundirection\" exclude each other", angle);
  const Vec3d toward = to_double(p.vec3("sundirection"));
  if (!(length(toward) > 0)) fail(p.where("sundirection"), "\"sundirection\" has the length 0: it is no direction");
  return toward / length(toward);
}

SkyModel::SkyModel(const Params& p) : toward_sun(frond::toward_sun(p)), is_overcast(p.string("sky") == "overcast") {
  const double zenith = sun_zenith_deg();
  const Atmosphere air{.sun_zenith_deg = std::min(zenith, 90.0),
                       .aerosol = p.real("aerosol"),
                       .angstrom = p.real("angstrom"),
                       .water_cm = p.real("water"),
                       .ozone_atm_cm = p.real("ozone"),
                       .pressure_Pa = p.real("pressure"),
                       .albedo = p.real("albedo"),
                       .day = p.integer("day")};
  sun_radius = kSunRadius * std::sqrt(sun_distance_factor(air.day));
  const ClearSkyIrradiance clear = spectrl2(air);
  nm = clear.nm, direct_normal = clear.direct_normal, diffuse = clear.diffuse;
  const bool is_night = zenith >= 90 || is_black();
  if (is_night)
    p.warn(p.given("sundirection") ? "sundirection" : "elevation",
           "the sun is not above the horizon: this light is black (twilight is not modelled)");
  for (size_t i = 0; i < nm.size(); ++i) {
    if (is_overcast) diffuse[i] = kOvercastTransmission * (direct_normal[i] * toward_sun.z + diffuse[i]);
    if (is_night) diffuse[i] = 0;
    if (is_night || is_overcast) direct_normal[i] = 0;
  }
  if (p.given("cietype"))
    shape = cie_sky(p.integer("cietype"));
  else if (is_overcast || is_night)
    shape = cie_sky(kCieOvercast);
  else
    shape = perez_sky(zenith, integral(nm, direct_normal), integral(nm, diffuse));
}

/// Returns the integrals over the upper hemisphere of a sky's shape: of its radiance times the cosine, and of its
/// radiance.
struct ShapeIntegrals {
  double irradiance = 0, sphere = 0;
  ShapeIntegrals(const SkyShape& shape, double sun_zenith_deg) {
    constexpr int kRings = 512, kSectors = 512;
    const Vec3d sun{std::sin(sun_zenith_deg * kRadians), 0, std::cos(sun_zenith_deg * kRadians)};
    for (int i = 0; i < kRings; ++i) {
      // Midpoints of cos^2, which is uniform for directions with the density of the cosine.
      const double z = std::sqrt((i + 0.5) / kRings), r = std::sqrt(1 - z * z);
      double sum = 0;
      for (int j = 0; j < kSectors; ++j) {  // half of the sky, which is symmetric
        const double phi = kPiD * (j + 0.5) / kSectors;
        const double cos_gamma = std::clamp(r * std::cos(phi) * sun.x + z * sun.z, -1.0, 1.0);
        sum += double(shape.radiance(float(z), float(std::acos(cos_gamma))));
      }
      irradiance += kPiD * sum / (kRings * kSectors);
      sphere += kPiD * sum / (kRings * kSectors) / z;
    }
  }
};

SpectrumPtr spectrum(const SkyModel& model, const std::vector<double>& values, double factor) {
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < values.size(); ++i) points.push_back({model.nm[i], values[i] * factor});
  return make_tabulated(points);
}

/// Sun and clear sky, or overcast sky. Black below the horizon.
class SkyLight final : public EnvironmentLight {
 public:
  SkyLight(const Params& p, const Transform& world_from_light) : SkyLight(p, world_from_light, SkyModel(p)) {}

  /// Samples the sun's disc, or the sky by its share of the irradiance of a horizontal plane.
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(by_irradiance_, u, lambda);
  }
  /// Samples the sun's disc, or the sky by its radiance above the mean: scattered rays find the uniform part as well.
  std::optional<LightSample> sample_competing(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(by_excess_, u, lambda);
  }
  SampledSpectrum radiance(const Vec3&, const Vec3& direction, const SampledWavelengths& lambda) const override {
    const float distance2 = distance2_to_sun(direction);
    SampledSpectrum result = sky_radiance(direction, distance2, lambda);
    if (has_sun_ && disc_.contains(distance2)) result += disc_radiance_->sample(lambda);
    return result;
  }
  float pdf(const Vec3&, const Vec3& direction) const override { return density(by_irradiance_, direction); }
  float competing_pdf(const Vec3&, const Vec3& direction) const override { return density(by_excess_, direction); }
  bool is_delta() const override { return false; }
  /// Power of the light that enters a sphere of the scene's radius.
  double power(float radius) const override { return kPiD * double(radius) * double(radius) * scalar_illuminance_; }
  /// Spectral irradiance of a horizontal plane.
  const Spectrum& emission() const override { return *total_; }
  std::optional<Vec3> sun() const override { return has_sun_ ? std::optional(disc_.toward()) : std::nullopt; }
  std::string summary() const override { return summary_; }

 private:
  static constexpr float kPerHemisphere = 0.5f * kInvPi;
  static constexpr int kTable = 64;  ///< cells along each side of the tables, about 2 degrees

  /// Share of the sun among samples, and distribution of the others over the sky.
  struct Sampling {
    float sun;
    Distribution2D sky;
  };

  SkyLight(const Params& p, const Transform& world_from_light, const SkyModel& model)
      : SkyLight(p, DirectionMap(world_from_light), model, ShapeIntegrals(model.shape, model.sun_zenith_deg())) {}
  SkyLight(const Params& p, const DirectionMap& directions, const SkyModel& model, const ShapeIntegrals& integrals)
      : shape_(model.shape),
        frame_(Frame::along(directions.to_world({0, 0, 1}), directions.to_world(to_float(model.toward_sun)))),
        disc_(directions.to_world(to_float(model.toward_sun)), model.sun_radius),
        has_sun_(model.direct_total() > 0),
        by_irradiance_(sampling_by_irradiance(model)),
        by_excess_(sampling_by_excess(model, integrals)) {
    if (!directions.is_rotation()) fail(p.where(), "the light's transform is not a rotation: it distorts the sky");
    std::vector<double> total(model.nm.size()), scalar(model.nm.size());
    const double per_diffuse = integrals.sphere / integrals.irradiance;
    for (size_t i = 0; i < total.size(); ++i) {
      total[i] = model.direct_normal[i] * std::max(0.0, model.toward_sun.z) + model.diffuse[i];
      scalar[i] = model.direct_normal[i] + model.diffuse[i] * per_diffuse;
    }
    const double scale = double(light_scale(p, "illuminance", photometric(*spectrum(model, total, 1))));
    total_ = spectrum(model, total, scale);
    scalar_illuminance_ = photometric(*spectrum(model, scalar, scale));
    disc_radiance_ = spectrum(model, model.direct_normal, scale / disc_.projected());
    sky_ = spectrum(model, model.diffuse, scale / integrals.irradiance);
    const double direct = scale * model.direct_total(), diffuse = scale * model.diffuse_total();
    summary_ = fmt::format(
        "sky: {}, sun {:.4g} degrees above the horizon; irradiance of a horizontal plane from 300 to 2500 nm: total "
        "{:.2f}, direct {:.2f}, diffuse {:.2f} W/m^2; a white horizontal surface has the luminance {:.4g}",
        model.is_overcast ? "overcast" : "clear", 90 - model.sun_zenith_deg(), direct + diffuse, direct, diffuse,
        photometric(*total_) / kPiD);
  }

  /// Returns the mean of a function of cosine and relative radiance over each cell of a table.
  template <class Weight>
  static std::vector<float> cells(const SkyModel& model, const Weight& weight) {
    constexpr int kPoints = 3;  // for each cell, along each side
    const double zenith = model.sun_zenith_deg() * kRadians;
    const Vec3 sun = to_float(Vec3d{std::sin(zenith), 0, std::cos(zenith)});
    std::vector<float> means;
    for (int y = 0; y < kTable; ++y)
      for (int x = 0; x < kTable; ++x) {
        float sum = 0;
        for (int k = 0; k < kPoints * kPoints; ++k) {
          const Vec2 at{(float(x) + (float(k % kPoints) + 0.5f) / kPoints) / kTable,
                        (float(y) + (float(k / kPoints) + 0.5f) / kPoints) / kTable};
          const Vec3 d = hemisphere_from_square(at);
          if (d.z > 0) sum += weight(d.z, model.shape.radiance(d.z, angle_of(dot(d - sun, d - sun))));
        }
        means.push_back(sum / (kPoints * kPoints));
      }
    return means;
  }
  /// Returns the sun's share of samples: that of its light, averaged over the wavelengths, but leaves some for each.
  /// The factors convert direct normal and diffuse irradiance to what is compared.
  static float sun_share(const SkyModel& model, double direct_factor, double diffuse_factor) {
    if (!(model.direct_total() > 0)) return 0;
    double share = 0;
    for (size_t i = 0; i < model.nm.size(); ++i) {
      const double direct = direct_factor * model.direct_normal[i], diffuse = diffuse_factor * model.diffuse[i];
      if (direct > 0) share += direct / (direct + diffuse) / double(model.nm.size());
    }
    return float(std::clamp(share, kLeastShare, 1 - kLeastShare));
  }
  static Sampling sampling_by_irradiance(const SkyModel& model) {
    return {sun_share(model, model.toward_sun.z, 1),
            Distribution2D(cells(model, [](float cosine, float radiance) { return cosine * radiance; }), kTable)};
  }
  /// Sun and sky count by the light that arrives from all directions, since surfaces may face any.
  static Sampling sampling_by_excess(const SkyModel& model, const ShapeIntegrals& integrals) {
    std::vector<float> radiances = cells(model, [](float, float radiance) { return radiance; });
    double mean = 0, excess = 0;
    for (const float r : radiances) mean += double(r) / double(radiances.size());
    for (float& r : radiances) {
      r = std::max(0.f, r - float(mean));
      excess += double(r) / double(radiances.size());
    }
    const double covered = mean > 0 ? excess / mean : 0;
    return {sun_share(model, 1, covered * integrals.sphere / integrals.irradiance), Distribution2D(radiances, kTable)};
  }

  /// Returns the angle of which `distance2` is the squared chord on the unit sphere.
  static float angle_of(float distance2) { return 2 * std::asin(std::min(1.f, std::sqrt(distance2) / 2)); }
  float distance2_to_sun(const Vec3& direction) const {
    const Vec3 d = direction - disc_.toward();
    return dot(d, d);
  }
  SampledSpectrum sky_radiance(const Vec3& direction, float distance2, const SampledWavelengths& lambda) const {
    const float z = dot(direction, frame_.z);
    if (!(z > 0)) return {};
    return sky_->sample(lambda) * shape_.radiance(z, angle_of(distance2));
  }
  float density(const Sampling& sampling, const Vec3& direction) const {
    float density = has_sun_ && disc_.contains(distance2_to_sun(direction)) ? sampling.sun * disc_.density() : 0;
    const Vec3 local = frame_.to_local(direction);
    if (local.z > 0) density += (1 - sampling.sun) * sampling.sky.pdf(square_from_hemisphere(local)) * kPerHemisphere;
    return density;
  }
  /// Returns nullopt if no light comes from the sampled direction.
  std::optional<LightSample> sample_from(const Sampling& sampling, Vec2 u, const SampledWavelengths& lambda) const {
    Vec3 wi;
    if (u.x < sampling.sun) {
      wi = disc_.sample({stretched(u.x, 0, sampling.sun), u.y});
    } else {
      const auto at = sampling.sky.sample({stretched(u.x, sampling.sun, 1), u.y});
      wi = frame_.to_world(hemisphere_from_square(at.uv));
    }
    const SampledSpectrum arriving = radiance({}, wi, lambda);
    if (arriving.is_black()) return {};
    const float pdf = density(sampling, wi);
    if (!(pdf > 0)) return {};
    return LightSample{arriving, wi, INFINITY, pdf};
  }

  static constexpr double kLeastShare = 0.1;  ///< of the sun and of the sky among samples: one may be in shadow

  SkyShape shape_;
  Frame frame_;  ///< world space: z is up, x toward the azimuth of the sun
  SunDisc disc_;
  bool has_sun_;
  Sampling by_irradiance_, by_excess_;
  SpectrumPtr disc_radiance_;  ///< W m^-2 sr^-1 nm^-1
  SpectrumPtr sky_;            ///< the same for shape_ 1
  SpectrumPtr total_;
  double scalar_illuminance_ = 0;  ///< integral of the luminance over all directions
  std::string summary_;
};

constexpr std::string_view kSkies[] = {"clear", "overcast"};
constexpr Param kSky[] = {
    {.name = "elevation",
     .kind = ParamKind::real,
     .default_value = 60.0,
     .unit = "degrees",
     .range = {-90, 90},
     .doc = "Angle of the sun above the horizon. At 0 and below the light is black, with a warning."},
    {.name = "azimuth",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .unit = "degrees",
     .doc = "Azimuth of the sun, from +x toward +y; +z of the light's space is up."},
    {.name = "sundirection",
     .kind = ParamKind::vector3,
     .doc = "Direction toward the sun, in place of elevation and azimuth."},
    {.name = "sky",
     .kind = ParamKind::string,
     .default_value = std::string_view("clear"),
     .doc = "clear: sun and sky by SPECTRL2. overcast: no direct sunlight; a quarter of the clear day's irradiance, of "
            "the "
            "same spectrum.",
     .choices = kSkies},
    {.name = "cietype",
     .kind = ParamKind::integer,
     .range = {1, kCieSkies},
     .doc = "Type of the CIE general sky that gives the angular distribution; by default Perez's all-weather sky if "
            "clear, "
            "1 if overcast."},
    {.name = "aerosol",
     .kind = ParamKind::real,
     .default_value = 0.1,
     .range = {0, 10},
     .doc = "Aerosol optical depth at 500 nm; 0.05 is very clear, 0.4 hazy."},
    {.name = "angstrom",
     .kind = ParamKind::real,
     .default_value = 1.14,
     .range = {-1, 4},
     .doc = "Angstrom exponent of the aerosol optical depth."},
    {.name = "water",
     .kind = ParamKind::real,
     .default_value = 1.42,
     .unit = "cm",
     .range = {0, 20},
     .doc = "Precipitable water."},
    {.name = "ozone",
     .kind = ParamKind::real,
     .default_value = 0.31,
     .unit = "atm-cm",
     .range = {0, 2},
     .doc = "Ozone column; 1 atm-cm is 1000 Dobson units."},
    {.name = "pressure",
     .kind = ParamKind::real,
     .default_value = 101325.0,
     .unit = "Pa",
     .range = {0, 120000},
     .doc = "Air pressure at the ground."},
    {.name = "albedo",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .range = {0, 1},
     .doc =
         "Ground albedo, which adds light reflected between ground and sky to the diffuse; leave it at 0 if the ground "
         "is in the scene."},
    {.name = "day",
     .kind = ParamKind::integer,
     .default_value = 172,
     .range = {1, 366},
     .doc = "Day of the year, for the distance of the sun; 172 is 21 June."},
    {.name = "scale",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .range = kAtLeastZero,
     .doc = "Factor; at 1, radiance is in W/(m^2 sr nm)."},
    {.name = "illuminance",
     .kind = ParamKind::real,
     .unit = "lx",
     .doc = "Illuminance of a horizontal plane, to which the light is scaled; with pi a white one has the luminance 1. "
            "0 or "
            "less: not given."},
};

}  // namespace

extern const LightInfo sky_light{{"light", "sky", "Sun and clear sky, or an overcast sky, with physical units.",
                                  "Bird and Riordan 1986; Perez et al. 1993; ISO 15469:2004", kSky},
                                 make_light<SkyLight>};

}  // namespace frond
