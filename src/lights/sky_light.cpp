#include <fmt/format.h>

#include "core/error.h"
#include "core/light.h"
#include "core/math/direction_map.h"
#include "core/math/sampling.h"
#include "core/math/vec.h"
#include "lights/hemisphere_table.h"
#include "lights/light_params.h"
#include "lights/sky_model.h"
#include "lights/sky_spectra.h"
#include "lights/station.h"
#include "spectra/cie.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

/// The disc of the sun, of uniform radiance.
class SunDisc {
 public:
  /// `toward`: unit, world space; `radius`: angle, rad.
  SunDisc(const Vec3& toward, double radius)
      : frame_(Frame::around(toward)),
        sine_(float(std::sin(radius))),
        chord2_(float(4 * std::pow(std::sin(radius / 2), 2) * (1 + kRounding))),
        density_(float(1 / (2 * kPiD * (1 - std::cos(radius))))) {}

  const Vec3& toward() const { return frame_.z; }
  /// Returns whether a direction with this squared distance from the centre's unit vector is on the disc.
  bool contains(float distance2) const { return distance2 <= chord2_; }
  /// Samples the disc. The density over solid angle varies by 1e-5 and counts as constant.
  Vec3 sample(Vec2 u) const {
    const float r = sine_ * std::sqrt(u.x), phi = 2 * kPi * u.y;
    return frame_.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)});
  }
  float density() const { return density_; }
  /// Irradiance over radiance on a plane that faces the sun.
  double projected() const { return kPiD * double(sine_) * double(sine_); }

 private:
  static constexpr double kRounding = 2e-5;  ///< samples of the edge are on the disc
  Frame frame_;
  float sine_, chord2_, density_;
};

/// Throws InputError at `where` if the values are too large for floats.
SpectrumPtr spectrum(const SkyModel& model, const std::vector<double>& values, double factor, const Location& where) {
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < values.size(); ++i) points.push_back({model.nm[i], values[i] * factor, where});
  return make_tabulated(points);
}

/// Sun and clear sky, or overcast sky. Below the horizon is a Lambertian ground, which only scattered rays find.
class SkyLight final : public EnvironmentLight {
 public:
  SkyLight(const Params& p, const Transform& world_from_light) : SkyLight(p, world_from_light, SkyModel(p)) {}

  /// Samples the sun's disc, or the sky by its share of the irradiance of a horizontal plane.
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(by_irradiance_, u, lambda);
  }
  /// Samples the sun's disc, or the sky by its radiance above the mean: scattered rays find the uniform part as well.
  std::optional<LightSample> sample_compensated(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(by_excess_, u, lambda);
  }
  SampledSpectrum radiance(const Vec3&, const Vec3& direction, const SampledWavelengths& lambda) const override {
    const SkySpectra::Sample spectra = spectra_.at(lambda);
    if (!(dot(direction, frame_.z) > 0)) return spectra.sky * ground_by_sky_ + spectra.disc * ground_by_disc_;
    const float distance2 = distance2_to_sun(direction);
    const SampledSpectrum sky = spectra.sky * relative_radiance(direction, distance2);
    return is_sun(distance2) ? sky + spectra.disc : sky;
  }
  float pdf(const Vec3&, const Vec3& direction) const override { return density(by_irradiance_, direction); }
  float compensated_pdf(const Vec3&, const Vec3& direction) const override { return density(by_excess_, direction); }
  bool is_delta() const override { return false; }
  /// Power of the light that enters a sphere of the scene's radius.
  double power(float radius) const override { return kPiD * double(radius) * double(radius) * scalar_illuminance_; }
  /// Spectral irradiance of a horizontal plane.
  const Spectrum& emission() const override { return *total_; }
  std::optional<Vec3> sun() const override { return has_sun_ ? std::optional(disc_.toward()) : std::nullopt; }
  std::string summary() const override { return summary_; }

 private:
  /// Share of the sun among samples, and distribution of the others over the sky.
  struct Sampling {
    float sun;
    HemisphereTable sky;
    float on_disc = 0;  ///< density on the disc
  };

  SkyLight(const Params& p, const Transform& world_from_light, const SkyModel& model)
      : SkyLight(p, DirectionMap(world_from_light), model, ShapeIntegrals(model.shape, model.sun_zenith_deg())) {}
  SkyLight(const Params& p, const DirectionMap& directions, const SkyModel& model, const ShapeIntegrals& integrals)
      : tables_(model.shape),
        frame_(Frame::along(directions.to_world({0, 0, 1}), directions.to_world(to_float(model.toward_sun)))),
        disc_(directions.to_world(to_float(model.toward_sun)), model.sun_radius),
        has_sun_(model.direct_total() > 0),
        at_sun_(relative_radiance(disc_.toward(), 0)),
        by_irradiance_(sampling_by_irradiance(model)),
        by_excess_(sampling_by_excess(model, integrals)) {
    if (!directions.is_rotation()) fail(p.where(), "the light's transform is not a rotation: it distorts the sky");
    std::vector<double> total(model.nm.size()), scalar(model.nm.size());
    const double per_diffuse = integrals.sphere / integrals.irradiance;
    for (size_t i = 0; i < total.size(); ++i) {
      total[i] = model.direct_normal[i] * std::max(0.0, model.toward_sun.z) + model.diffuse[i];
      scalar[i] = model.direct_normal[i] + model.diffuse[i] * per_diffuse + 2 * p.real("albedo") * total[i];
    }
    const double scale = double(light_scale(p, "illuminance", photometric(*spectrum(model, total, 1, p.where()))));
    const Location& brightness = p.where(p.given("illuminance") ? "illuminance" : "scale");
    total_ = spectrum(model, total, scale, brightness);
    scalar_illuminance_ = photometric(*spectrum(model, scalar, scale, brightness));
    spectra_ = SkySpectra(model, scale / integrals.irradiance, scale * model.horizon_factor() / disc_.projected());
    // Radiance of the ground: reflectance times irradiance over pi.
    const double reflectance = p.real("albedo") / kPiD, sine = std::max(0.0, model.toward_sun.z);
    ground_by_sky_ = float(reflectance * integrals.irradiance);
    ground_by_disc_ = float(reflectance * sine * disc_.projected() / model.horizon_factor());
    for (Sampling* sampling : {&by_irradiance_, &by_excess_}) sampling->on_disc = sun_density(*sampling);
    const double direct = scale * model.direct_total(), diffuse = scale * model.diffuse_total();
    summary_ = fmt::format(
        "sky: {}, sun {:.4g} degrees above the horizon; irradiance of a horizontal plane from 300 to 2500 nm: total "
        "{:.2f}, direct {:.2f}, diffuse {:.2f} W/m^2; a white horizontal surface has the luminance {:.4g}",
        model.is_overcast ? "overcast" : "clear", 90 - model.sun_zenith_deg(), direct + diffuse, direct, diffuse,
        photometric(*total_) / kPiD);
  }

  /// Returns the integral of a function of cosine and relative radiance over each cell of a table, up to a factor.
  template <class Weight>
  static std::vector<float> cells(const SkyModel& model, const Weight& weight) {
    constexpr int kPoints = 3;  // for each cell, along each side
    const double zenith = model.sun_zenith_deg() * kDegree;
    const Vec3 sun = to_float(Vec3d{std::sin(zenith), 0, std::cos(zenith)});
    std::vector<float> sums(size_t(HemisphereTable::kSide * HemisphereTable::kSide));
    for (size_t cell = 0; cell < sums.size(); ++cell)
      for (int k = 0; k < kPoints * kPoints; ++k) {
        const Vec2 offset{(float(k % kPoints) + 0.5f) / kPoints, (float(k / kPoints) + 0.5f) / kPoints};
        const Vec3 d = hemisphere_from_square(HemisphereTable::point(cell, offset));
        const float angle = 2 * std::asin(std::min(1.f, length(d - sun) / 2));
        sums[cell] += weight(d.z, model.shape.radiance(d.z, angle)) * solid_angle_per_area(octahedral_norm(d));
      }
    return sums;
  }
  /// Returns the sun's share of samples: its share of the light, averaged over the wavelengths, within bounds that
  /// leave samples for both sun and sky. The factors convert direct normal and diffuse irradiance to what is compared.
  static float sun_share(const SkyModel& model, double direct_factor, double diffuse_factor) {
    if (!(model.direct_total() > 0)) return 0;
    double share = 0;
    for (size_t i = 0; i < model.nm.size(); ++i) {
      const double direct = direct_factor * model.direct_normal[i], diffuse = diffuse_factor * model.diffuse[i];
      if (direct > 0) share += direct / (direct + diffuse) / double(model.nm.size());
    }
    return float(std::clamp(share, kLeastSun, 1 - kLeastSky));
  }
  static Sampling sampling_by_irradiance(const SkyModel& model) {
    return {sun_share(model, model.toward_sun.z, 1),
            HemisphereTable(cells(model, [](float cosine, float radiance) { return cosine * radiance; }))};
  }
  /// Sun and sky count by the light that arrives from all directions, since surfaces may face any.
  static Sampling sampling_by_excess(const SkyModel& model, const ShapeIntegrals& integrals) {
    const auto mean = float(integrals.sphere / (2 * kPiD));
    const auto sum = [&](const auto& weight) {
      double total = 0;
      for (const float w : cells(model, weight)) total += double(w);
      return total;
    };
    const auto excess = [mean](float, float radiance) { return std::max(0.f, radiance - mean); };
    const double covered = sum(excess) / sum([](float, float radiance) { return radiance; });
    return {sun_share(model, 1, covered * integrals.sphere / integrals.irradiance),
            HemisphereTable(cells(model, excess))};
  }

  float distance2_to_sun(const Vec3& direction) const {
    const Vec3 d = direction - disc_.toward();
    return dot(d, d);
  }
  bool is_sun(float distance2) const { return has_sun_ && disc_.contains(distance2); }
  /// Returns the relative radiance of the sky without the sun.
  float relative_radiance(const Vec3& direction, float distance2) const {
    const float z = dot(direction, frame_.z);
    return z > 0 ? tables_.radiance(z, distance2) : 0;
  }
  float sky_density(const Sampling& sampling, const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    if (!(local.z > 0)) return 0;
    return (1 - sampling.sun) * sampling.sky.pdf(local);
  }
  /// On the disc, the sky's part, of the order of 1e-4 of the radiance, is taken at the disc's centre.
  float sun_density(const Sampling& sampling) const {
    return sampling.sun * disc_.density() + sky_density(sampling, disc_.toward());
  }
  float density(const Sampling& sampling, const Vec3& direction) const {
    return is_sun(distance2_to_sun(direction)) ? sampling.on_disc : sky_density(sampling, direction);
  }
  /// Returns nullopt if no light comes from the sampled direction.
  std::optional<LightSample> sample_from(const Sampling& sampling, Vec2 u, const SampledWavelengths& lambda) const {
    const SkySpectra::Sample spectra = spectra_.at(lambda);
    if (u.x < sampling.sun) {
      const Vec3 wi = disc_.sample({remap_sample(u.x, 0, sampling.sun), u.y});
      if (!(dot(wi, frame_.z) > 0)) return {};
      return LightSample{spectra.disc + spectra.sky * at_sun_, wi, INFINITY, sampling.on_disc};
    }
    const auto [local, density] = sampling.sky.sample({remap_sample(u.x, sampling.sun, 1), u.y});
    const Vec3 wi = frame_.to_world(local);
    const float distance2 = distance2_to_sun(wi);
    const bool on_disc = is_sun(distance2);
    SampledSpectrum arriving = spectra.sky * relative_radiance(wi, distance2);
    if (on_disc) arriving += spectra.disc;
    if (arriving.is_black() || !(density > 0)) return {};
    const float pdf = on_disc ? sampling.on_disc : (1 - sampling.sun) * density;
    return LightSample{arriving, wi, INFINITY, pdf};
  }

  // Least shares of the samples: the sun or the bright part of the sky may be in shadow. Scattered rays find the sky,
  // too.
  static constexpr double kLeastSun = 0.1, kLeastSky = 0.03;

  SkyTables tables_;
  Frame frame_;  ///< world space: z is up, x toward the azimuth of the sun
  SunDisc disc_;
  bool has_sun_;
  float at_sun_;  ///< relative radiance of the sky at the centre of the sun
  Sampling by_irradiance_, by_excess_;
  SkySpectra spectra_;  ///< W m^-2 sr^-1 nm^-1; of the sky, where its relative radiance is 1
  float ground_by_sky_ = 0,
        ground_by_disc_ = 0;  ///< the ground's radiance over the radiance of sky and disc in spectra_
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
     .doc = "Angle of the sun above the horizon. At 0 and below the light is black, with a warning.",
     .quantity = PhysicalQuantity::angle},
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
     .doc = "Precipitable water.",
     .quantity = PhysicalQuantity::water_vapour},
    {.name = "ozone",
     .kind = ParamKind::real,
     .default_value = 0.31,
     .unit = "atm-cm",
     .range = {0, 2},
     .doc = "Ozone column; 1 atm-cm is 1000 Dobson units.",
     .quantity = PhysicalQuantity::ozone},
    {.name = "pressure",
     .kind = ParamKind::real,
     .default_value = 101325.0,
     .unit = "Pa",
     .range = {0, 120000},
     .doc = "Air pressure at the ground.",
     .quantity = PhysicalQuantity::air_pressure},
    {.name = "albedo",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .range = {0, 1},
     .doc = "Albedo of the ground, for light reflected between ground and sky and for the radiance below the horizon; "
            "leave it "
            "at 0, which is black, if the ground is in the scene."},
    {.name = "day",
     .kind = ParamKind::integer,
     .default_value = 172,
     .range = {1, 366},
     .doc = "Day of the year, for the distance of the sun; 172 is 21 June."},
    kGlobalIrradiance,
    kDiffuseIrradiance,
    kDirectNormalIrradiance,
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
