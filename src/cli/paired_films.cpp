#include "cli/paired_films.h"

#include "scene/resolver.h"

namespace frond {

std::unique_ptr<Sampler> make_sampler(const SceneDescription& description, const Registry& registry,
                                      const WavelengthStrategy& wavelengths, uint64_t seed) {
  SceneResolver resolver(description, registry, wavelengths);
  const SamplerInfo& info = registry.samplers.get(description.sampler.name, description.sampler.where);
  return info.make(Params(info, description.sampler, resolver), seed);
}

PairedFilms::PairedFilms(const FilmSettings& film, std::array<uint64_t, 2> seeds, const SceneDescription& description,
                         const Registry& registry, const WavelengthStrategy& wavelengths,
                         std::vector<PixelPlace> places)
    : seeds_(seeds),
      films_{Film(film, {}, wavelengths.bands().size()), Film(film, {}, wavelengths.bands().size())},
      places_(std::move(places)) {
  for (size_t i = 0; i < 2; ++i) samplers_[i] = make_sampler(description, registry, wavelengths, seeds_[i]);
}

void PairedFilms::advance_to(uint64_t samples, const RenderedWorld& rendered, const ThreadPool& pool,
                             const Progress& progress) {
  if (samples <= samples_) return;
  const auto& [world, wavelengths, view] = rendered;
  for (size_t i = 0; i < 2; ++i) {
    const RenderJob job{world,         view.camera(), view.integrator(), wavelengths,        view.filter(),
                        *samplers_[i], seeds_[i],     samples_,          samples - samples_, places_};
    const RenderStatistics s = render(job, films_[i], pool, progress);
    cost_.wall_seconds += s.wall_seconds / 2;
    cost_.cpu_seconds += s.cpu_seconds / 2;
    cost_.rays += double(s.rays) / 2;
  }
  samples_ = samples;
}

void PairedFilms::restore(const std::array<FilmSums, 2>& films, uint64_t samples, const RenderCost& cost) {
  for (size_t i = 0; i < 2; ++i) films_[i].restore(films[i].pixels, films[i].bands);
  samples_ = samples;
  cost_ = cost;
}

}  // namespace frond
