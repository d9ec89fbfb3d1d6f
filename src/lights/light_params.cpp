#include "lights/light_params.h"

#include <fmt/format.h>

#include <limits>

#include "core/error.h"
#include "spectra/wavelengths/radiant.h"

namespace frond {

std::optional<double> stated_total(const Params& p, std::string_view name) {
  if (!p.given(name)) return {};
  const double total = p.real(name);
  if (total > 0) return total;
  p.warn(name, fmt::format("\"{}\" {} counts as not given, as in pbrt-v4: the light has its own", name, total));
  return {};
}

/// `unit_total` is the total at scale 1. Throws InputError if it is 0, or if the scale is too large for a float.
float light_scale(const Params& p, std::string_view total, double unit_total) {
  const std::optional<double> stated = stated_total(p, total);
  if (!stated) return float(p.real("scale"));
  if (!(unit_total > 0)) fail(p.where(total), "the light is black: it has no {} to scale", total);
  const double scale = p.real("scale") * *stated / unit_total;
  if (!(scale <= double(std::numeric_limits<float>::max())))
    fail(p.where(total), "the light has the {} {:.4g} at scale 1: the factor to the stated one is beyond {:.2g}", total,
         unit_total, std::numeric_limits<float>::max());
  return float(scale);
}

std::optional<double> stated_power(const Params& p, const Spectrum& spectrum) {
  const bool is_radiant = p.given("radiantpower"), is_photons = p.given("photonflux");
  if (!is_radiant && !is_photons) return {};
  const std::string_view name = is_photons ? "photonflux" : "radiantpower";
  if ((is_radiant && is_photons) || p.given("power"))
    fail(p.where(name), "\"{}\" and \"{}\" exclude each other", name, p.given("power") ? "power" : "radiantpower");
  const double own = is_photons ? par_photons(spectrum) : radiant_integral(spectrum);
  if (!(own > 0))
    fail(p.where(name), "the spectrum has no {}", is_photons ? "light from 400 to 700 nm" : "light to scale");
  return p.real(name) / own;
}

float lamp_scale(const Params& p, const Spectrum& spectrum, double unit_flux, double geometry) {
  const std::optional<double> stated = stated_power(p, spectrum);
  if (!stated) return light_scale(p, "power", unit_flux);
  if (!(geometry > 0)) fail(p.where(), "the light is black: it has no power to scale");
  return float(p.real("scale") * *stated / geometry);
}

}  // namespace frond
