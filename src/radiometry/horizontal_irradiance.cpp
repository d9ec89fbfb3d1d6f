#include "radiometry/horizontal_irradiance.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

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

/// Returns the irradiance of one light on the plane.
std::array<double, kLanes> irradiance(const Light& light, const SampledWavelengths& lambda, int directions) {
  std::array<double, kLanes> sum{};
  const int count = light.is_delta() ? 1 : directions;
  for (int i = 0; i < count; ++i) {
    const Vec2 u{(float(i) + 0.5f) / float(count), radical_inverse(uint32_t(i))};
    const auto s = light.sample({}, u, lambda);
    if (!s || s->wi.z <= 0 || s->pdf <= 0) continue;
    for (size_t lane = 0; lane < kLanes; ++lane) sum[lane] += double(s->radiance.v[lane] * s->wi.z / s->pdf) / count;
  }
  return sum;
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
  if (listed.empty()) {
    const Interval range = wavelengths.range_nm();
    for (double nm = std::floor(range.min); nm <= std::ceil(range.max); ++nm) nm_.push_back(nm);
  } else {
    nm_.assign(listed.begin(), listed.end());
  }
  shares_.resize(lights.size());
  for (size_t begin = 0; begin < nm_.size(); begin += kLanes) {
    const SampledWavelengths lambda = lanes_at(std::span(nm_).subspan(begin));
    std::array<double, kLanes> sum{};
    std::vector<std::array<double, kLanes>> each;
    for (const Light* light : lights) {
      each.push_back(irradiance(*light, lambda, kDirections));
      for (size_t lane = 0; lane < kLanes; ++lane) sum[lane] += each.back()[lane];
    }
    for (size_t i = 0; i < each.size(); ++i)
      for (size_t lane = 0; lane < size_t(lambda.count); ++lane)
        if (sum[lane] > 0) shares_[i] += each[i][lane] / sum[lane] / double(nm_.size());
    values_.insert(values_.end(), sum.begin(), sum.begin() + lambda.count);
  }
  for (size_t i = 0; i < nm_.size(); ++i)
    if (!(values_[i] > 0))
      fail(loaded.description().lights.empty() ? Location{} : loaded.description().lights[0].plugin.where,
           "no light falls on the scene from above, from +z, at {:g} nm", nm_[i]);
  sum_bands(wavelengths);
}

void HorizontalIrradiance::sum_bands(const WavelengthStrategy& wavelengths) {
  const size_t count = wavelengths.bands().size();
  if (!wavelengths.listed_nm().empty()) {
    bands_ = values_;
    return;
  }
  constexpr size_t kPaths = 4096;  // paths for each band
  std::vector<double> sum(count), seen(count);
  for (size_t i = 0; i < kPaths * count; ++i) {
    const size_t turn = i / count;
    const float u = (float(turn) + 0.5f) / float(kPaths);
    const SampledWavelengths lambda = wavelengths.sample_in_turn(i, u);
    const SensorResponse response = wavelengths.sensor(at(lambda), lambda);
    for (size_t k = 0; k < size_t(response.count); ++k)
      sum[response.channel[k]] += response.value[k], ++seen[response.channel[k]];
  }
  for (size_t b = 0; b < count; ++b) bands_.push_back(sum[b] / seen[b]);
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
