#pragma once

#include "cli/compare/study.h"
#include "integrators/render.h"

namespace frond::compare {

/// What one render of a pair has cost so far, on average of the two.
struct RenderCost {
  double wall_seconds = 0, cpu_seconds = 0, rays = 0;
};

/// What a film has summed up.
struct FilmSums {
  std::vector<Film::Pixel> pixels;
  std::vector<Film::BandSums> bands;
};

/// Two renders of one picture with seeds of their own, which tell noise from bias. They can be continued to more
/// samples at any time, and then hold the very sums of a render that had all of them at once.
class PairedRender {
 public:
  /// Throws InputError where this machine has no room for the films of `pairs` such pairs.
  PairedRender(const Study& study, const Candidate& candidate, uint64_t first_seed, uint64_t second_seed,
               size_t pairs = 1);

  /// Up to so many samples a pixel; nothing where there are as many.
  void advance_to(uint64_t samples, const ThreadPool& pool, const Progress& progress);
  /// Goes on from what was kept of these two renders.
  void restore(const std::array<FilmSums, 2>& films, uint64_t samples, const RenderCost& cost);

  uint64_t samples() const { return samples_; }
  const RenderCost& cost() const { return cost_; }
  const Film& film(size_t half) const { return films_[half]; }
  const Scene& scene() const { return *scene_; }
  /// CPU time of making the scene ready, tables included.
  double setup_cpu_seconds() const { return setup_cpu_seconds_; }

 private:
  double setup_cpu_seconds_;
  std::unique_ptr<Scene> scene_;
  std::array<uint64_t, 2> seeds_;
  std::array<std::unique_ptr<Sampler>, 2> samplers_;
  std::array<Film, 2> films_;
  uint64_t samples_ = 0;
  RenderCost cost_;
};

}  // namespace frond::compare
