#include "radiometry/lit_bands.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/spectrum_points.h"

namespace frond {
namespace {

/// Throws InputError for the first wavelength at which `lit`, a response times another irradiance, is above 0, and the
/// scene's irradiance is 0: no path carries such light.
void check_scene_has_light(const std::vector<ResponsePoint>& lit, const Spectrum& of_scene, const std::string& name) {
  std::vector<double> nm = points_nm(of_scene, {lit.front().nm, lit.back().nm});
  for (const ResponsePoint& p : lit) nm.push_back(p.nm);
  std::ranges::sort(nm);
  auto above = lit.begin();
  for (size_t i = 1; i < nm.size(); ++i) {
    if (nm[i] <= nm[i - 1]) continue;
    const double middle = (nm[i - 1] + nm[i]) / 2;
    while (above->nm < middle) ++above;
    if (std::max(above[-1].value, above->value) > 0 && of_scene.at(float(middle)) == 0)
      fail({},
           "the lights of the scene give no light at {:.6g} nm, where the irradiance that band {} is weighted by has "
           "some: give the scene a light that has all wavelengths",
           middle, name);
  }
}

/// Returns the direct part of an irradiance by whose spectrum that of the scene is replaced: at each wavelength, the
/// scene's ratio of direct to all light remains.
SpectrumPtr direct_part(const Spectrum& irradiance, const HorizontalIrradiance& of_scene, Interval range_nm) {
  std::vector<double> nm = points_nm(irradiance, range_nm);
  append_points_nm(*of_scene.spectrum(), nm);
  complete_points_nm(range_nm, nm);
  std::vector<SpectrumPoint> points;
  for (const double at : nm) {
    const double all = double(of_scene.spectrum()->at(float(at))), direct = double(of_scene.direct()->at(float(at)));
    points.push_back({at, all > 0 ? double(irradiance.at(float(at))) * direct / all : 0});
  }
  return std::make_shared<TabulatedSpectrum>(points);
}

/// Returns the light under a response; 0 if there is none.
BandLight light_under(std::span<const ResponsePoint> response, const Spectrum& spectrum) {
  const std::vector<ResponsePoint> lit = lit_response(response, spectrum);
  if (lit.empty()) return {};
  const ResponseSampler sampler(lit, {});
  return {sampler.integral(), sampler.centroid_nm()};
}

}  // namespace

void check_covers(const Spectrum& irradiance, Interval needed_nm, std::string_view what) {
  const Interval known = irradiance.range_nm();
  if ((known.min <= needed_nm.min || irradiance.at(float(known.min)) == 0) &&
      (known.max >= needed_nm.max || irradiance.at(float(known.max)) == 0))
    return;
  fail({},
       "the irradiance is known from {:g} to {:g} nm, {} {:g} to {:g} nm: where there is no light, let its table end "
       "with 0",
       known.min, known.max, what, needed_nm.min, needed_nm.max);
}

LitBands::LitBands(const WavelengthStrategy& strategy, const HorizontalIrradiance& of_scene,
                   const SpectrumPtr& irradiance, std::span<const Interval> ranges)
    : strategy_(strategy) {
  for (size_t i = 0; i < strategy.bands().size(); ++i) {
    Band band = strategy.bands()[i];
    if (band.response.empty()) continue;
    if (!ranges.empty()) band.response = {{ranges[i].min, 1}, {ranges[i].max, 1}};
    const Spectrum& light = irradiance ? *irradiance : *of_scene.spectrum();
    if (irradiance)
      check_covers(light, {band.response.front().nm, band.response.back().nm}, fmt::format("band {} needs", band.name));
    const std::vector<ResponsePoint> lit = lit_response(band.response, light);
    if (lit.empty()) fail({}, "the irradiance is 0 in band {}", band.name);
    if (irradiance) check_scene_has_light(lit, *of_scene.spectrum(), band.name);
    samplers_.emplace_back(lit, Location{});
    const Interval range{band.response.front().nm, band.response.back().nm};
    direct_.push_back(
        light_under(band.response, irradiance ? *direct_part(*irradiance, of_scene, range) : *of_scene.direct()));
  }
}

uint64_t turns_of(const WavelengthStrategy& strategy) {
  const auto bands_of = [&](uint64_t index) {
    const SampledWavelengths lambda = strategy.sample_for_index(index, 0.5f);
    std::vector<uint16_t> bands(lambda.band.begin(), lambda.band.begin() + lambda.count);
    std::ranges::sort(bands);
    return bands;
  };
  uint64_t turns = 1;
  while (bands_of(turns) != bands_of(0)) ++turns;
  return turns;
}

}  // namespace frond
