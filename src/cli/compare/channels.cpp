#include "cli/compare/channels.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "spectra/band_preview.h"
#include "spectra/cie.h"
#include "spectra/color_space.h"

namespace frond::compare {
namespace {

ChannelList colors() {
  return {.names = {"rgb", "red", "green", "blue", "luminance"},
          .shown = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .unit = std::string(kErrorSpace)};
}

std::string name_of(const Band& band) { return fmt::format("{:.8g} nm", band.nm); }

/// Spectrum of all lights, each by its photometric power, at luminance 1.
double white_at(const Scene& scene, float nm) {
  double sum = 0, power = 0;
  for (const Light* light : scene.lights()) {
    const double p = light->power(scene.radius());
    if (!(p > 0)) continue;
    power += p;
    sum += p * double(light->emission().at(nm)) / photometric(light->emission());
  }
  return power > 0 ? sum / power : 0;
}

/// Of a band with a response, its mean under that.
double white_in(const Scene& scene, const Band& band) {
  if (!band.response) return white_at(scene, float(band.nm));
  constexpr int kSteps = 256;
  const Interval range = band.response->range_nm();
  double sum = 0, weight = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto nm = float(std::lerp(range.min, range.max, (i + 0.5) / kSteps));
    const auto w = double(band.response->at(nm));
    sum += w * white_at(scene, nm), weight += w;
  }
  return sum / weight;
}

/// As the eye sees them, where they cover what it sees; else three of them as red, green and blue.
void choose_picture(ChannelList& list) {
  const size_t count = list.bands.size();
  const auto xyz = xyz_of_bands(list.bands);
  list.shown.assign(count, Triple{});
  if (!xyz.empty()) {
    const Matrix3& to_rgb = color_space(kErrorSpace, {}).rgb_from_xyz;
    for (size_t b = 0; b < count; ++b) {
      const Triple rgb = to_rgb * xyz[b];
      for (size_t c = 0; c < 3; ++c) list.shown[b][c] = rgb[c] * list.white[b];
    }
    list.how_shown = "colours by linear interpolation between the bands";
    return;
  }
  const std::array<size_t, 3> shown{count - 1, count / 2, 0};
  for (size_t c = 0; c < 3; ++c) list.shown[shown[c]][c] = 1;
  list.how_shown = fmt::format("false colours: {} as red, {} as green, {} as blue", name_of(list.bands[shown[0]]),
                               name_of(list.bands[shown[1]]), name_of(list.bands[shown[2]]));
}

ChannelList bands_of(const Scene& scene) {
  const auto bands = scene.wavelengths().bands();
  ChannelList list{
      .names = {"all bands"}, .bands = {bands.begin(), bands.end()}, .unit = "radiance over that of white"};
  for (const Band& band : list.bands) {
    list.names.push_back(name_of(band));
    list.white.push_back(white_in(scene, band));
    if (!(list.white.back() > 0))
      fail({}, "the scene's lights give no light at {}: there is nothing to compare", name_of(band));
  }
  choose_picture(list);
  return list;
}

bool same_response(const SpectrumPtr& a, const SpectrumPtr& b) {
  if (!a || !b) return !a && !b;
  const Interval range = a->range_nm();
  if (b->range_nm().min != range.min || b->range_nm().max != range.max) return false;
  constexpr int kSteps = 256;
  for (int i = 0; i <= kSteps; ++i)
    if (const auto nm = float(std::lerp(range.min, range.max, double(i) / kSteps)); a->at(nm) != b->at(nm))
      return false;
  return true;
}

}  // namespace

ChannelList channels_of(const Scene& scene) { return scene.wavelengths().bands().empty() ? colors() : bands_of(scene); }

uint64_t samples_for_all_channels(const Scene& scene) {
  std::set<uint16_t> seen;
  const size_t bands = scene.wavelengths().bands().size();
  uint64_t samples = 0;
  do {
    const SampledWavelengths lambda = scene.wavelengths().sample_in_turn(samples++, 0.5f);
    seen.insert(lambda.band.begin(), lambda.band.begin() + lambda.count);
  } while (seen.size() < bands);
  return samples;
}

bool same_channels(const ChannelList& a, const ChannelList& b) {
  return a.names == b.names && std::ranges::equal(a.bands, b.bands, same_response, &Band::response, &Band::response);
}

}  // namespace frond::compare
