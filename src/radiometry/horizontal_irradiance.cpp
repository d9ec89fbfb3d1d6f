#include "radiometry/horizontal_irradiance.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fluorescence.h"
#include "core/stop.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/band_label.h"
#include "spectra/wavelengths/response_sampler.h"
#include "spectra/wavelengths/spectrum_points.h"

namespace frond {
namespace {

/// Returns up to kLanes wavelengths of the list.
SampledWavelengths lanes_at(std::span<const double> nm) {
  SampledWavelengths lambda;
  lambda.count = int(std::min<size_t>(nm.size(), kLanes));
  for (size_t i = 0; i < size_t(lambda.count); ++i) {
    lambda.nm[i] = float(nm[i]);
    lambda.pdf[i] = 1;
    lambda.active[i] = true;
  }
  return lambda;
}

/// Van der Corput sequence in base 2, by reversing bits.
float radical_inverse(uint32_t i) {
  i = (i << 16) | (i >> 16);
  i = ((i & 0x00ff00ff) << 8) | ((i & 0xff00ff00) >> 8);
  i = ((i & 0x0f0f0f0f) << 4) | ((i & 0xf0f0f0f0) >> 4);
  i = ((i & 0x33333333) << 2) | ((i & 0xcccccccc) >> 2);
  i = ((i & 0x55555555) << 1) | ((i & 0xaaaaaaaa) >> 1);
  return float(i >> 8) * 0x1p-24f;
}

/// Returns the irradiance of one light on the plane at up to kLanes wavelengths.
std::array<double, kLanes> irradiance(const Light& light, const SampledWavelengths& lambda) {
  constexpr int kDirections = 1 << 16;
  std::array<double, kLanes> sum{};
  const int count = light.is_delta() ? 1 : kDirections;
  for (int i = 0; i < count; ++i) {
    const Vec2 u{(float(i) + 0.5f) / float(count), radical_inverse(uint32_t(i))};
    const auto s = light.sample({}, u, lambda);
    if (!s || s->wi.z <= 0 || s->pdf <= 0) continue;
    for (size_t lane = 0; lane < kLanes; ++lane) sum[lane] += double(s->radiance.v[lane] * s->wi.z / s->pdf) / count;
  }
  return sum;
}

/// Returns the irradiance of one light on the plane at each wavelength.
std::vector<double> irradiance(const Light& light, std::span<const double> nm) {
  std::vector<double> values;
  for (size_t begin = 0; begin < nm.size(); begin += kLanes) {
    check_stop();
    const SampledWavelengths lambda = lanes_at(nm.subspan(begin));
    const auto four = irradiance(light, lambda);
    values.insert(values.end(), four.begin(), four.begin() + lambda.count);
  }
  return values;
}

/// Returns wavelengths between which the spectra of all lights are linear, or smooth.
std::vector<double> points_nm(std::span<const Light* const> lights, Interval range_nm) {
  std::vector<double> nm;
  for (const Light* light : lights) append_points_nm(light->emission(), nm);
  complete_points_nm(range_nm, nm);
  return nm;
}

SpectrumPtr spectrum_of(std::span<const double> nm, std::span<const double> values) {
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < nm.size(); ++i) points.push_back({nm[i], values[i]});
  return std::make_shared<TabulatedSpectrum>(points);
}

/// Throws InputError, which names the light, unless all lights are outside the scene.
void check_distant(const Scene& scene) {
  for (const Light* light : scene.lights())
    if (!light->is_distant())
      fail(scene.light_where(size_t(light->index())),
           "brf and flux need lights outside the scene: \"distant\", \"sky\", or \"infinite\" without a portal; this "
           "light has a position in it");
}

}  // namespace

HorizontalIrradiance::HorizontalIrradiance(const LoadedScene& loaded) {
  check_distant(loaded.scene());
  const auto lights = loaded.scene().lights();
  const WavelengthStrategy& wavelengths = loaded.scene().wavelengths();
  const auto listed = wavelengths.listed_nm();
  const Interval range = wavelengths.range_nm();
  nm_ = listed.empty() ? points_nm(lights, {std::floor(range.min), std::ceil(range.max)})
                       : std::vector<double>(listed.begin(), listed.end());
  values_.resize(nm_.size());
  std::vector<std::vector<double>> each;
  for (const Light* light : lights) {
    each.push_back(irradiance(*light, nm_));
    for (size_t i = 0; i < nm_.size(); ++i) values_[i] += each.back()[i];
  }
  const auto lit = std::ranges::count_if(values_, [](double value) { return value > 0; });
  for (const auto& of_light : each) {
    double& share = shares_.emplace_back();
    for (size_t i = 0; i < nm_.size(); ++i)
      if (values_[i] > 0) share += of_light[i] / values_[i] / double(lit);
  }
  if (listed.empty()) spectrum_ = spectrum_of(nm_, values_);
  for (const Band& band : wavelengths.bands()) {
    bands_.push_back(band.response.empty() ? at(double(float(band.nm))) : mean_under(band.response, *spectrum_));
    if (!(bands_.back() > 0 || is_of_fluorescence(band)))
      fail(loaded.description().lights.empty() ? Location{} : loaded.description().lights[0].plugin.where,
           "no light falls on the scene from above, from +z, {}", place_of(band));
  }
}

SpectrumPtr horizontal_irradiance(const Scene& scene, Interval nm) {
  const std::vector<double> points = points_nm(scene.lights(), nm);
  std::vector<double> values(points.size());
  for (const Light* light : scene.lights()) {
    const std::vector<double> of_light = irradiance(*light, points);
    for (size_t i = 0; i < points.size(); ++i) values[i] += of_light[i];
  }
  return spectrum_of(points, values);
}

SampledSpectrum HorizontalIrradiance::at(const SampledWavelengths& lambda) const {
  SampledSpectrum result;
  for (int i = 0; i < lambda.count; ++i) result[i] = float(at(double(lambda.nm[size_t(i)])));
  return result;
}

double HorizontalIrradiance::at(double nm) const {
  const auto above = std::ranges::lower_bound(nm_, nm);
  if (above == nm_.begin()) return values_.front();
  if (above == nm_.end()) return values_.back();
  const auto i = size_t(above - nm_.begin());
  return std::lerp(values_[i - 1], values_[i], (nm - nm_[i - 1]) / (nm_[i] - nm_[i - 1]));
}

std::optional<Vec3> direction_to_sun(std::span<const Light* const> lights) {
  std::optional<Vec3> sun;
  const std::vector<double> any{550};
  for (const Light* light : lights) {
    if (!light->is_distant()) continue;
    std::optional<Vec3> toward = light->sun();
    if (light->is_delta()) {
      const auto sample = light->sample({}, {}, lanes_at(any));
      if (sample) toward = sample->wi;
    }
    if (!toward || toward->z <= 0) continue;
    if (sun) return {};
    sun = toward;
  }
  return sun;
}

}  // namespace frond
