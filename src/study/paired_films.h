#pragma once

#include <array>

#include "render/render_loop.h"
#include "scene/scene.h"

namespace frond {

/// What one render of a pair has cost so far, on average of the two.
struct RenderCost {
  double wall_seconds = 0, cpu_seconds = 0, rays = 0;
};

/// The description's sampler, with a seed of its own.
std::unique_ptr<Sampler> make_sampler(const SceneSettings& description, const Registry& registry,
                                      const WavelengthStrategy& wavelengths, uint64_t seed);

/// The unit of films of a scene (FilmFormat).
int film_exponent(const Scene& scene);

/// Two renders of one image with seeds of their own, which tell noise from bias. They can be continued to more
/// samples at any time, and then hold the very sums of a render that had all of them at once.
class PairedFilms {
 public:
  /// By the description's sampler; films of the scene's wavelengths, with their colours as they are, in units of
  /// 2^exponent. `pixels`: as in a RenderJob.
  PairedFilms(const FilmSettings& film, int exponent, std::array<uint64_t, 2> seeds, const SceneSettings& description,
              const Registry& registry, const Scene& scene, std::vector<PixelPosition> pixels = {});

  /// Up to so many samples a pixel; nothing where there are as many. `scene` is that of the constructor.
  void advance_to(uint64_t samples, const Scene& scene, const ThreadPool& pool, Progress* progress);
  /// Goes on from what was kept of these two renders.
  void restore(std::array<Film, 2> films, uint64_t samples, const RenderCost& cost);

  uint64_t samples() const { return samples_; }
  const RenderCost& cost() const { return cost_; }
  const Film& film(size_t half) const { return films_[half]; }

 private:
  RenderJob job(size_t half, const Scene& scene) const;

  std::array<uint64_t, 2> seeds_;
  std::array<std::unique_ptr<Sampler>, 2> samplers_;
  std::vector<PixelPosition> pixels_;
  std::array<Film, 2> films_;
  uint64_t samples_ = 0;
  RenderCost cost_;
};

}  // namespace frond
