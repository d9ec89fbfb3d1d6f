#include "study/paired_films.h"

#include "scene/resolver.h"

namespace frond {

std::unique_ptr<Sampler> make_sampler(const SceneDescription& description, const Registry& registry,
                                      const WavelengthStrategy& wavelengths, uint64_t seed) {
  SceneResolver resolver(description, registry, wavelengths);
  const SamplerInfo& info = registry.samplers.get(description.sampler.name, description.sampler.where);
  return info.make(Params(info, description.sampler, resolver), seed);
}

PairedFilms::PairedFilms(const FilmSettings& film, std::array<uint64_t, 2> seeds, const SceneDescription& description,
                         const Registry& registry, const RenderedWorld& rendered, std::vector<PixelPlace> places)
    : seeds_(seeds),
      samplers_{make_sampler(description, registry, rendered.wavelengths, seeds[0]),
                make_sampler(description, registry, rendered.wavelengths, seeds[1])},
      places_(std::move(places)),
      films_{Film({film}), Film({film})} {
  FilmFormat format{.settings = film, .bands = rendered.wavelengths.bands().size()};
  // The view's own, so that films of other leaves in it have the same unit, and the same bits where they do not differ.
  const Scene& view = rendered.view;
  format.exponent = film_exponent(
      {view, view.camera(), view.integrator(), view.wavelengths(), view.filter(), view.sampler(), view.seed()},
      view.film());
  for (Film& half : films_) half = Film(format);
}

RenderJob PairedFilms::job(size_t half, const RenderedWorld& r) const {
  return {r.world,         r.view.camera(),  r.view.integrator(), r.wavelengths,
          r.view.filter(), *samplers_[half], seeds_[half],        places_};
}

void PairedFilms::advance_to(uint64_t samples, const RenderedWorld& rendered, const ThreadPool& pool,
                             Progress* progress) {
  if (samples <= samples_) return;
  for (size_t i = 0; i < 2; ++i) {
    const RenderStatistics s =
        render(job(i, rendered), plan_of(films_[i], {samples_, samples}), films_[i], pool, {.progress = progress});
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
