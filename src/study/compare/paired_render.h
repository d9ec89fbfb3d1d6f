#pragma once

#include "study/compare/study.h"
#include "study/paired_films.h"

namespace frond::compare {

/// Two independent renders of a study's scene with one candidate.
class PairedRender {
 public:
  /// Throws InputError if this machine lacks memory for the films of `pairs` such pairs.
  PairedRender(const Study& study, const Candidate& candidate, uint64_t first_seed, uint64_t second_seed,
               size_t pairs = 1);

  /// Continues to `samples` samples per pixel; does nothing if they are present.
  void advance_to(uint64_t samples, const ThreadPool& pool, Progress* progress) {
    films_.advance_to(samples, *scene_, pool, progress);
  }
  /// Continues from a saved state of these two renders.
  void restore(std::array<Film, 2> films, uint64_t samples, const RenderCost& cost) {
    films_.restore(std::move(films), samples, cost);
  }

  uint64_t samples() const { return films_.samples(); }
  const RenderCost& cost() const { return films_.cost(); }
  const Film& film(size_t half) const { return films_.film(half); }
  const Scene& scene() const { return *scene_; }
  /// Returns the CPU time of the scene's construction, including tables.
  double setup_cpu_seconds() const { return setup_cpu_seconds_; }

 private:
  double setup_cpu_seconds_;
  std::shared_ptr<const Scene> scene_;
  PairedFilms films_;
};

}  // namespace frond::compare
