#pragma once

#include <array>

#include "render/render_loop.h"
#include "scene/scene.h"

namespace frond {

/// Cost of one render, as the mean of the two.
struct RenderCost {
  double wall_seconds = 0, cpu_seconds = 0, rays = 0;
};

/// Returns the description's sampler with another seed.
std::unique_ptr<Sampler> make_sampler(const SceneSettings& description, const Registry& registry,
                                      const WavelengthStrategy& wavelengths, uint64_t seed);

/// Two independent renders of one image, which separate noise from bias. They can be continued; the sums are then
/// exactly those of an uninterrupted render.
class PairedFilms {
 public:
  /// Uses the description's sampler. Films have the scene's wavelengths, without colour conversion, in units of
  /// 2^exponent. `pixels`: as in a RenderInputs.
  PairedFilms(const FilmSettings& film, int exponent, std::array<uint64_t, 2> seeds, const SceneSettings& description,
              const Registry& registry, const Scene& scene, std::vector<PixelPosition> pixels = {});

  /// Continues to `samples` samples per pixel; does nothing if they are present. `scene` must be the constructor's.
  void advance_to(uint64_t samples, const Scene& scene, const ThreadPool& pool, Progress* progress);
  /// Continues from a saved state of these two renders.
  void restore(std::array<Film, 2> films, uint64_t samples, const RenderCost& cost);

  uint64_t samples() const { return samples_; }
  const RenderCost& cost() const { return cost_; }
  const Film& film(size_t half) const { return films_[half]; }

 private:
  RenderInputs job(size_t half, const Scene& scene) const;

  std::array<std::unique_ptr<Sampler>, 2> samplers_;
  std::vector<PixelPosition> pixels_;
  std::array<Film, 2> films_;
  uint64_t samples_ = 0;
  RenderCost cost_;
};

}  // namespace frond
