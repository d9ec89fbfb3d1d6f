#include "radiometry/horizontal_irradiance.h"

#include <algorithm>
#include <cmath>

#include "core/emission.h"
#include "core/error.h"
#include "core/fluorescence.h"
#include "core/math/vec.h"
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

/// Irradiance at up to kLanes wavelengths: of all light, and of the direct light.
struct LaneIrradiance {
  std::array<double, kLanes> all{}, direct{};
};

/// Returns the irradiance of one light on the plane.
LaneIrradiance irradiance(const Light& light, const SampledWavelengths& lambda) {
  constexpr int kDirections = 1 << 16;
  LaneIrradiance sum;
  const int count = light.is_delta() ? 1 : kDirections;
  for (int i = 0; i < count; ++i) {
    const Vec2 u{(float(i) + 0.5f) / float(count), radical_inverse(uint32_t(i))};
    const auto s = light.sample({}, u, lambda);
    if (!s || s->wi.z <= 0 || s->pdf <= 0) continue;
    const bool direct = is_direct(light, s->wi);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const double of_sample = double(s->radiance.v[lane] * s->wi.z / s->pdf) / count;
      sum.all[lane] += of_sample;
      if (direct) sum.direct[lane] += of_sample;
    }
  }
  return sum;
}

/// Returns the spectral power of a lamp in the scene at up to kLanes wavelengths; all of it counts as diffuse.
LaneIrradiance power(const EmissionSampler& lamp, const SampledWavelengths& lambda) {
  constexpr int kRays = 1 << 13;
  LaneIrradiance sum;
  RandomStream random(1);
  for (int i = 0; i < kRays; ++i) {
    const Vec2 point{random.uniform(), random.uniform()};
    const auto ray = lamp.sample_emission(point, {(float(i) + 0.5f) / kRays, radical_inverse(uint32_t(i))}, lambda);
    for (size_t lane = 0; ray && lane < kLanes; ++lane) sum.all[lane] += double(ray->power.v[lane]) / kRays;
  }
  return sum;
}

/// Irradiance of one light on the plane at each wavelength of a list.
struct ListedIrradiance {
  std::vector<double> all, direct;
};

/// `light` may be a lamp in the scene: its spectral power takes the place of the irradiance.
ListedIrradiance irradiance(const Light& light, std::span<const double> nm, const ThreadPool& pool = ThreadPool(1)) {
  ListedIrradiance values{std::vector<double>(nm.size()), std::vector<double>(nm.size())};
  pool.for_each(int64_t((nm.size() + kLanes - 1) / kLanes), [&](int64_t group, int) {
    const size_t begin = size_t(group) * kLanes;
    const SampledWavelengths lambda = lanes_at(nm.subspan(begin));
    const auto* lamp = light.is_distant() ? nullptr : dynamic_cast<const EmissionSampler*>(&light);
    const LaneIrradiance four = lamp ? power(*lamp, lambda) : irradiance(light, lambda);
    std::copy_n(four.all.begin(), lambda.count, values.all.begin() + int64_t(begin));
    std::copy_n(four.direct.begin(), lambda.count, values.direct.begin() + int64_t(begin));
  });
  return values;
}

/// Returns wavelengths between which the spectra of all lights are linear, or smooth.
std::vector<double> points_nm(std::span<const Light* const> lights, Interval range_nm) {
  std::vector<double> nm;
  for (const Light* light : lights) append_points_nm(light->emission(), nm);
  complete_points_nm(range_nm, nm);
  return nm;
}

/// Returns the irradiance of one light at each wavelength; of an extended light from fewer wavelengths, those of its
/// own table and every kStep_nm, between which the ratio to the light's emission is linear. The time is mostly that of
/// the directions of a sky.
ListedIrradiance irradiance_by_ratio(const Light& light, const std::vector<double>& nm) {
  constexpr double kStep_nm = 10;
  if (light.is_delta()) return irradiance(light, nm);
  std::vector<double> few{nm.front(), nm.back()};
  append_points_nm(light.emission(), few);
  for (double at = std::ceil(nm.front() / kStep_nm) * kStep_nm; at < nm.back(); at += kStep_nm) few.push_back(at);
  std::erase_if(few, [&nm](double at) { return at < nm.front() || at > nm.back(); });
  std::ranges::sort(few);
  few.erase(std::ranges::unique(few).begin(), few.end());
  const ListedIrradiance known = irradiance(light, few);
  const auto emitted = [&light](double at) { return double(light.emission().at(float(at))); };
  ListedIrradiance values;
  size_t above = 1;
  for (const double at : nm) {
    while (above + 1 < few.size() && few[above] < at) ++above;
    const double t = (at - few[above - 1]) / (few[above] - few[above - 1]), emission = emitted(at);
    const auto of_light = [&](const std::vector<double>& of_few) {
      const auto ratio = [&](size_t i) { return emitted(few[i]) > 0 ? of_few[i] / emitted(few[i]) : 0; };
      return std::lerp(ratio(above - 1), ratio(above), t) * emission;
    };
    values.all.push_back(of_light(known.all));
    values.direct.push_back(of_light(known.direct));
  }
  return values;
}

SpectrumPtr spectrum_of(std::span<const double> nm, std::span<const double> values) {
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < nm.size(); ++i) points.push_back({nm[i], values[i]});
  return std::make_shared<TabulatedSpectrum>(points);
}

/// Throws InputError, which names the light, unless all lights are outside the scene or, if they may be, lamps in it.
void check_lights(const Scene& scene, bool may_be_lamps) {
  for (const Light* light : scene.lights()) {
    const bool is_lamp = may_be_lamps && dynamic_cast<const EmissionSampler*>(light);
    if (!light->is_distant() && !is_lamp)
      fail(scene.light_where(size_t(light->index())),
           "{} lights outside the scene: \"distant\", \"sky\", or \"infinite\" without a portal; this light has a "
           "position "
           "in it",
           may_be_lamps ? "flux needs lamps that can be sampled, or" : "brf needs");
  }
}

}  // namespace

bool has_lamps(std::span<const Light* const> lights) {
  return std::ranges::any_of(
      lights, [](const Light* light) { return !light->is_distant() && dynamic_cast<const EmissionSampler*>(light); });
}

bool is_direct(const Light& light, const Vec3& toward) {
  if (light.is_delta()) return true;
  const auto sun = light.sun();
  if (!sun) return false;
  const Vec3 apart = toward - *sun;
  const double chord = 2 * std::sin(kSunAngle_deg * kDegree / 2);
  return double(dot(apart, apart)) < chord * chord;
}

HorizontalIrradiance::HorizontalIrradiance(const LoadedScene& loaded, const std::optional<Interval>& range_nm,
                                           const std::optional<double>& target_area) {
  check_lights(loaded.scene(), target_area.has_value());
  const auto lights = loaded.scene().lights();
  if (target_area && has_lamps(lights)) area_ = *target_area;
  const WavelengthStrategy& wavelengths = loaded.scene().wavelengths();
  const auto listed = wavelengths.listed_nm();
  Interval range = wavelengths.range_nm();
  if (range_nm) {
    range = {std::min(range.min, range_nm->min), std::max(range.max, range_nm->max)};
    for (const Light* light : lights)
      if (!(light->range_nm().min <= range.min && light->range_nm().max >= range.max))
        fail(loaded.scene().light_where(size_t(light->index())),
             "this light is known from {:g} to {:g} nm, the bands need {:g} to {:g} nm", light->range_nm().min,
             light->range_nm().max, range.min, range.max);
  }
  nm_ = listed.empty() ? points_nm(lights, {std::floor(range.min), std::ceil(range.max)})
                       : std::vector<double>(listed.begin(), listed.end());
  values_.resize(nm_.size());
  std::vector<double> direct(nm_.size());
  std::vector<std::vector<double>> each;
  for (const Light* light : lights) {
    ListedIrradiance of_light = range_nm ? irradiance_by_ratio(*light, nm_) : irradiance(*light, nm_);
    if (light->is_distant())
      for (auto* values : {&of_light.all, &of_light.direct})
        for (double& value : *values) value *= area_;
    for (size_t i = 0; i < nm_.size(); ++i) values_[i] += of_light.all[i], direct[i] += of_light.direct[i];
    each.push_back(std::move(of_light.all));
  }
  const auto lit = std::ranges::count_if(values_, [](double value) { return value > 0; });
  for (const auto& of_light : each) {
    double& share = shares_.emplace_back();
    for (size_t i = 0; i < nm_.size(); ++i)
      if (values_[i] > 0) share += of_light[i] / values_[i] / double(lit);
  }
  if (listed.empty()) spectrum_ = spectrum_of(nm_, values_), direct_ = spectrum_of(nm_, direct);
  for (const Band& band : wavelengths.bands()) {
    bands_.push_back(band.response.empty() ? at(double(float(band.nm))) : mean_under(band.response, *spectrum_));
    if (!(bands_.back() > 0 || is_of_fluorescence(band)))
      fail(loaded.description().lights.empty() ? Location{} : loaded.description().lights[0].plugin.where, "{} {}",
           has_lamps(lights) ? "the lamps have no light" : "no light falls on the scene from above, from +z,",
           place_of(band));
  }
}

SpectrumPtr horizontal_irradiance(const Scene& scene, Interval nm, const ThreadPool& pool, double target_area) {
  const std::vector<double> points = points_nm(scene.lights(), nm);
  std::vector<double> values(points.size());
  for (const Light* light : scene.lights()) {
    const std::vector<double> of_light = irradiance(*light, points, pool).all;
    const double area = light->is_distant() && has_lamps(scene.lights()) ? target_area : 1;
    for (size_t i = 0; i < points.size(); ++i) values[i] += of_light[i] * area;
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
