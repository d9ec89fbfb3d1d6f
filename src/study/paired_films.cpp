#include "study/paired_films.h"

#include "scene/resolver.h"

namespace frond {

std::unique_ptr<Sampler> make_sampler(const SceneSettings& description, const Registry& registry,
                                      const WavelengthStrategy& wavelengths, uint64_t seed) {
  SceneResolver resolver(description, registry, wavelengths);
  const SamplerInfo& info = registry.samplers.get(description.sampler.name, description.sampler.where);
  return make_checked(info, description.sampler.where,
                      [&] { return info.make(Params(info, description.sampler, resolver), seed); });
}

PairedFilms::PairedFilms(const FilmSettings& film, int exponent, std::array<uint64_t, 2> seeds,
                         const SceneSettings& description, const Registry& registry, const Scene& scene,
                         std::vector<PixelPosition> pixels)
    : samplers_{make_sampler(description, registry, scene.wavelengths(), seeds[0]),
                make_sampler(description, registry, scene.wavelengths(), seeds[1])},
      pixels_(std::move(pixels)),
      films_{Film({film}), Film({film})} {
  const FilmFormat format{.settings = film, .bands = scene.wavelengths().bands().size(), .exponent = exponent};
  for (Film& half : films_) half = Film(format);
}

RenderInputs PairedFilms::job(size_t half, const Scene& scene) const {
  RenderInputs job = job_of(scene, scene.integrator(), *samplers_[half]);
  job.pixels = pixels_;
  return job;
}

void PairedFilms::advance_to(uint64_t samples, const Scene& scene, const ThreadPool& pool, Progress* progress) {
  if (samples <= samples_) return;
  for (size_t i = 0; i < 2; ++i) {
    const RenderStatistics s =
        render(job(i, scene), plan_of(films_[i], {samples_, samples}), films_[i], pool, {.progress = progress});
    cost_.wall_seconds += s.wall_seconds / 2;
    cost_.cpu_seconds += s.cpu_seconds / 2;
    cost_.rays += double(s.rays) / 2;
  }
  samples_ = samples;
}

void PairedFilms::restore(std::array<Film, 2> films, uint64_t samples, const RenderCost& cost) {
  films_ = std::move(films);
  samples_ = samples;
  cost_ = cost;
}

}  // namespace frond
