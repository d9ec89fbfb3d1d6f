#pragma once

#include "study/compare/study.h"
#include "study/paired_films.h"

namespace frond::compare {

/// Two renders of a study's scene with one candidate.
class PairedRender {
 public:
  /// Throws InputError where this machine has no room for the films of `pairs` such pairs.
  PairedRender(const Study& study, const Candidate& candidate, uint64_t first_seed, uint64_t second_seed,
               size_t pairs = 1);

  /// Up to so many samples a pixel; nothing where there are as many.
  void advance_to(uint64_t samples, const ThreadPool& pool, Progress* progress) {
    films_.advance_to(samples, *scene_, pool, progress);
  }
  /// Goes on from what was kept of these two renders.
  void restore(std::array<Film, 2> films, uint64_t samples, const RenderCost& cost) {
    films_.restore(std::move(films), samples, cost);
  }

  uint64_t samples() const { return films_.samples(); }
  const RenderCost& cost() const { return films_.cost(); }
  const Film& film(size_t half) const { return films_.film(half); }
  const Scene& scene() const { return *scene_; }
  /// CPU time of making the scene ready, tables included.
  double setup_cpu_seconds() const { return setup_cpu_seconds_; }

 private:
  double setup_cpu_seconds_;
  std::shared_ptr<const Scene> scene_;
  PairedFilms films_;
};

}  // namespace frond::compare
