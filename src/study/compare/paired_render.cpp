#include "study/compare/paired_render.h"

#include "system/machine.h"

namespace frond::compare {
namespace {

FilmSettings checked_film(const Study& study, const Scene& scene, size_t films) {
  check_memory({.settings = study.film(), .bands = scene.wavelengths().bands().size()}, films, {},
               "--size takes fewer pixels");
  return study.film();
}

}  // namespace

PairedRender::PairedRender(const Study& study, const Candidate& candidate, uint64_t first_seed, uint64_t second_seed,
                           size_t pairs)
    : setup_cpu_seconds_(cpu_seconds()),
      scene_(study.scene(candidate)),
      films_(checked_film(study, *scene_, 2 * pairs), film_exponent(job_of(*scene_), scene_->film().exposure),
             {first_seed, second_seed}, study.description(), study.registry(), *scene_) {
  setup_cpu_seconds_ = cpu_seconds() - setup_cpu_seconds_;
}

}  // namespace frond::compare
