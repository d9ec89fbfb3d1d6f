#include "study/compare/channels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/wavelengths/band_preview.h"
#include "spectra/wavelengths/response_sampler.h"

namespace frond::compare {
namespace {

ChannelList colors() {
  return {.names = {"rgb", "red", "green", "blue", "luminance"},
          .shown = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .unit = std::string(kErrorSpace)};
}

std::string name_of(const Band& band) { return band.name.empty() ? fmt::format("{:.8g} nm", band.nm) : band.name; }

/// Spectrum of all lights, each weighted by its photometric power, normalized to luminance 1.
class White {
 public:
  explicit White(const Scene& scene) {
    double sum = 0;
    for (const Light* light : scene.lights()) {
      const double power = light->power(scene.radius());
      if (!(power > 0)) continue;
      sum += power;
      lights_.push_back({&light->emission(), power / photometric(light->emission())});
    }
    for (Share& light : lights_) light.weight /= sum;
  }

  /// Returns the value in a band; for a band with a response, the mean weighted by it.
  double band_value(const Band& band) const {
    return band.response.empty() ? at(band.nm) : response_mean(band.response);
  }

 private:
  struct Share {
    const Spectrum* emission;
    double weight;
  };

  double at(double nm) const {
    double sum = 0;
    for (const Share& light : lights_) sum += light.weight * double(light.emission->at(float(nm)));
    return sum;
  }

  double response_mean(std::span<const ResponsePoint> response) const {
    double sum = 0;
    for (const Share& light : lights_) sum += light.weight * mean_under(response, *light.emission);
    return sum;
  }

  std::vector<Share> lights_;
};

/// Chooses the displayed image: colours as perceived if the bands cover the visible range, else three bands as red,
/// green and blue.
void choose_image(ChannelList& list) {
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
  std::vector<size_t> ascending(count);
  std::iota(ascending.begin(), ascending.end(), 0);
  std::ranges::stable_sort(ascending, {}, [&list](size_t b) { return list.bands[b].nm; });
  const std::array shown{ascending[count - 1], ascending[count / 2], ascending[0]};
  for (size_t c = 0; c < 3; ++c) list.shown[shown[c]][c] = 1;
  list.how_shown = fmt::format("false colours: {} as red, {} as green, {} as blue", name_of(list.bands[shown[0]]),
                               name_of(list.bands[shown[1]]), name_of(list.bands[shown[2]]));
}

ChannelList bands_of(const Scene& scene) {
  const auto bands = scene.wavelengths().bands();
  ChannelList list{
      .names = {"all bands"}, .bands = {bands.begin(), bands.end()}, .unit = "radiance over that of white"};
  const White white(scene);
  for (const Band& band : list.bands) {
    list.names.push_back(name_of(band));
    list.white.push_back(white.band_value(band));
    if (!(list.white.back() > 0))
      fail({}, "the scene's lights give no light in the band {}: there is nothing to compare", name_of(band));
  }
  choose_image(list);
  return list;
}

}  // namespace

ChannelList channels_of(const Scene& scene) { return scene.wavelengths().bands().empty() ? colors() : bands_of(scene); }

uint64_t samples_for_all_channels(const Scene& scene) {
  std::set<uint16_t> seen;
  const size_t bands = scene.wavelengths().bands().size();
  uint64_t samples = 0;
  do {
    const SampledWavelengths lambda = scene.wavelengths().sample_for_index(samples++, 0.5f);
    seen.insert(lambda.band.begin(), lambda.band.begin() + lambda.count);
  } while (seen.size() < bands);
  return samples;
}

bool same_channels(const ChannelList& a, const ChannelList& b) {
  return a.names == b.names && std::ranges::equal(a.bands, b.bands, {}, &Band::response, &Band::response);
}

}  // namespace frond::compare
