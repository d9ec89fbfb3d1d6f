#include "scene/pilot_rays.h"

#include <algorithm>
#include <numeric>

#include "core/math/random.h"
#include "scene/scene.h"
#include "spectra/color/color_space.h"

namespace frond {

// Sample values are the sampler's, in the dimensions of the render loop, so that the samples of a pixel are as well
// distributed as in the render. There is no pixel filter: if pixels share samples, the noise is the noise of the
// samples inside a pixel. Each pilot pixel has its own samples, because small images have fewer pixels than the pilot
// requests. If there are more bands than lanes, all bundles carry the same bands: the difference between two bundles is
// then noise alone.
PathBundle ScenePilotRays::bundle(uint64_t pixel, uint64_t number) const {
  constexpr uint32_t kSamples = PathBundle::kMost;
  const FilmSettings& film = scene_.film();
  const Sampler& sampler = scene_.sampler();
  RandomStream place(hash_key(scene_.seed(), pixel));
  const int x = std::min(int(place.uniform() * float(film.width)), film.width - 1);
  const int y = std::min(int(place.uniform() * float(film.height)), film.height - 1);
  constexpr uint32_t kAll = (1u << kSamples) - 1;
  PathBundle bundle{
      .sampler = sampler, .samples = {x, y, (2 * pixel + number) * kSamples, kSamples}, .lanes = kAll, .wanted = kAll};
  std::array<Vec2, kSamples> on_film, on_lens{};
  std::array<float, kSamples> time{}, wavelength;
  sampler.get1d(bundle.samples, uint32_t(Dimension::wavelengths), wavelength.data());
  if (!scene_.has_wavelength_jitter()) wavelength.fill(0.5f);
  sampler.get2d(bundle.samples, uint32_t(Dimension::film), on_film.data());
  if (scene_.camera().uses_lens()) sampler.get2d(bundle.samples, uint32_t(Dimension::lens), on_lens.data());
  if (!scene_.has_pixel_jitter()) on_film.fill({0.5f, 0.5f}), on_lens.fill({0.5f, 0.5f});
  if (scene_.has_motion()) sampler.get1d(bundle.samples, uint32_t(Dimension::time), time.data());
  for (uint32_t k = 0; k < kSamples; ++k) {
    on_film[k] = {float(x) + on_film[k].x, float(y) + on_film[k].y};
    bundle.lambda[k] = scene_.wavelengths().sample_for_index(k, wavelength[k]);
    bundle.keys[k] = sample_key(scene_.seed(), x, y, bundle.samples.first + k);
  }
  scene_.camera().rays(on_film.data(), on_lens.data(), int(kSamples), bundle.rays.data());
  for (uint32_t k = 0; k < kSamples && scene_.has_motion(); ++k) {
    bundle.rays[k].time = time[k];
    if (const CameraMotion* motion = scene_.camera_motion()) motion->move(bundle.rays[k]);
  }
  return bundle;
}

// Linear sRGB in place of XYZ: the sampling of wavelengths keeps the sum of XYZ nearly free of noise, so that noise of
// XYZ would be noise of the brightness alone.
std::array<double, 3> ScenePilotRays::color(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const {
  const SensorResponse response = scene_.wavelengths().sensor(radiance, lambda);
  const std::string_view space = scene_.wavelengths().film_space();
  if (space.empty())
    return {std::accumulate(response.value.begin(), response.value.begin() + response.count, 0.), 0, 0};
  static const Matrix3 kSrgbFromXyz = find_color_space("linear sRGB")->rgb_from_xyz;
  return space == kXyzName ? kSrgbFromXyz * response.color() : response.color();
}

}  // namespace frond
