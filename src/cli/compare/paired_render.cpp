#include "cli/compare/paired_render.h"

#include <ctime>

namespace frond::compare {
namespace {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

Film film_of(const Study& study, const Scene& scene, size_t films) {
  const size_t bands = scene.wavelengths().bands().size();
  check_memory(study.film(), bands, films, {}, "--size takes fewer pixels");
  return Film(study.film(), {}, bands);
}

}  // namespace

PairedRender::PairedRender(const Study& study, const Candidate& candidate, uint64_t first_seed, uint64_t second_seed,
                           size_t pairs)
    : setup_cpu_seconds_(cpu_seconds()),
      scene_(study.scene(candidate)),
      seeds_{first_seed, second_seed},
      films_{film_of(study, *scene_, 2 * pairs), film_of(study, *scene_, 2 * pairs)} {
  setup_cpu_seconds_ = cpu_seconds() - setup_cpu_seconds_;
  for (size_t i = 0; i < 2; ++i) samplers_[i] = study.sampler(*scene_, seeds_[i]);
}

void PairedRender::advance_to(uint64_t samples, const ThreadPool& pool, const Progress& progress) {
  if (samples <= samples_) return;
  for (size_t i = 0; i < 2; ++i) {
    const RenderJob job{
        *scene_,   scene_->camera(), scene_->integrator(), scene_->wavelengths(), scene_->filter(), *samplers_[i],
        seeds_[i], samples_,         samples - samples_};
    const RenderStatistics s = render(job, films_[i], pool, progress);
    cost_.wall_seconds += s.wall_seconds / 2;
    cost_.cpu_seconds += s.cpu_seconds / 2;
    cost_.rays += double(s.rays) / 2;
  }
  samples_ = samples;
}

void PairedRender::restore(const std::array<FilmSums, 2>& films, uint64_t samples, const RenderCost& cost) {
  for (size_t i = 0; i < 2; ++i) films_[i].restore(films[i].pixels, films[i].bands);
  samples_ = samples;
  cost_ = cost;
}

}  // namespace frond::compare
