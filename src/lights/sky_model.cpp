#include "lights/sky_model.h"

#include <cmath>

#include "core/error.h"
#include "core/math/vec.h"
#include "lights/station.h"

namespace frond {
namespace {

constexpr double kSunRadius = 0.2666 * kDegree;  ///< at the mean distance
constexpr double kOvercastTransmission = 0.25;  ///< Kasten and Czeplak 1980, cloud cover 8/8: of the clear sky's global
constexpr int kCieOvercast = 1;                 ///< CIE standard overcast sky

/// Returns the direction toward the sun. Throws InputError if "sundirection" is 0 or is given besides the angles.
Vec3d toward_sun(const Params& p) {
  if (!p.given("sundirection")) {
    const double elevation = p.real("elevation") * kDegree, azimuth = p.real("azimuth") * kDegree;
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }
  for (const char* angle : {"elevation", "azimuth"})
    if (p.given(angle)) fail(p.where(angle), "\"{}\" and \"sundirection\" exclude each other", angle);
  const Vec3d toward = to_double(p.vec3("sundirection"));
  if (!(length(toward) > 0)) fail(p.where("sundirection"), "\"sundirection\" has the length 0: it is no direction");
  return toward / length(toward);
}

}  // namespace

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
  const bool is_night = zenith >= 90 || !(direct_total() + diffuse_total() > 0);
  if (is_night)
    p.warn(p.given("sundirection") ? "sundirection" : "elevation",
           "the sun is not above the horizon: this light is black (twilight is not modelled)");
  for (size_t i = 0; i < nm.size(); ++i) {
    if (is_overcast) diffuse[i] = kOvercastTransmission * (direct_normal[i] * toward_sun.z + diffuse[i]);
    if (is_night) diffuse[i] = 0;
    if (is_night || is_overcast) direct_normal[i] = 0;
  }
  if (!is_night) scale_to_measured(p);
  if (p.given("cietype"))
    shape = cie_sky(p.integer("cietype"));
  else if (is_overcast || !(diffuse_total() > 0))
    shape = cie_sky(kCieOvercast);
  else
    shape = perez_sky(zenith, integral(nm, direct_normal), integral(nm, diffuse));
}

/// The sun keeps its spectrum. Diffuse light keeps the spectrum of the model's sky as far as that reaches; the rest,
/// light of clouds, has that of the model's sun and sky together, as the overcast sky.
void SkyModel::scale_to_measured(const Params& p) {
  constexpr double kSolarConstant = 1361;  // W/m^2
  const SplitIrradiance model{direct_total(), diffuse_total()};
  const auto measured =
      measured_irradiance(p, model, toward_sun.z, kSolarConstant * sun_distance_factor(p.integer("day")));
  if (!measured) return;
  const double of_sun = model.direct > 0 ? measured->direct / model.direct : 0;
  const double of_sky = model.diffuse > 0 ? std::min(measured->diffuse / model.diffuse, 1.0) : 0;
  const double of_clouds = std::max(0.0, measured->diffuse - model.diffuse) / (model.direct + model.diffuse);
  for (size_t i = 0; i < nm.size(); ++i) {
    const double global = direct_normal[i] * toward_sun.z + diffuse[i];
    diffuse[i] = diffuse[i] * of_sky + global * of_clouds;
    direct_normal[i] *= of_sun;
  }
}

double SkyModel::horizon_factor() const {
  const double t = toward_sun.z / std::sin(sun_radius);
  if (!(t < 1) || t <= 0) return 1;
  // Mean of max(0, t + y) over the unit disc; t for a whole disc.
  const double mean = (t * (kPiD / 2 + std::asin(t)) + (2 + t * t) / 3 * std::sqrt(1 - t * t)) / kPiD;
  return t / mean;
}

double SkyModel::sun_zenith_deg() const { return std::acos(std::clamp(toward_sun.z, -1.0, 1.0)) / kDegree; }

ShapeIntegrals::ShapeIntegrals(const SkyShape& shape, double sun_zenith_deg) {
  constexpr int kRings = 512, kSectors = 512;
  const Vec3d sun{std::sin(sun_zenith_deg * kDegree), 0, std::cos(sun_zenith_deg * kDegree)};
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

}  // namespace frond
