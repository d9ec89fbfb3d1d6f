#pragma once

#include <string>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/overrides.h"
#include "scene/scene.h"

namespace frond::test {

struct RenderSettings {
  int samples = 16;
  uint64_t seed = 1;
  int threads = 2;
  std::string wavelengths = "smpte";
  std::vector<MaterialSwap> swaps = {};
  std::vector<const MaterialInfo*> materials = {};  ///< beside the built-in ones
  RenderStatistics* statistics = nullptr;           ///< filled in where given
};

/// Renders a scene that a test spells out.
inline Film render_text(const std::string& text, const RenderSettings& settings = {}) {
  const Log& quiet = silent_log();
  ThreadPool pool(settings.threads);
  SceneDescription description = parse_scene_text(text, "test.pbrt", quiet);
  Registry registry = make_registry(builtin_materials(), builtin_integrators());
  for (const MaterialInfo* info : settings.materials) registry.materials.add(*info);
  apply_overrides({.swaps = settings.swaps, .wavelengths = settings.wavelengths, .seed = settings.seed}, description,
                  registry, quiet);
  const Scene scene(description, registry, pool, quiet);
  Film film({.settings = scene.film(), .bands = scene.wavelengths().bands().size()});
  const RenderStatistics statistics = render(job_of(scene), plan_of(film, {0, uint64_t(settings.samples)}), film, pool);
  if (settings.statistics) *settings.statistics = statistics;
  return film;
}

/// Number of rays that were traced for a film.
inline uint64_t rays_of(const Film& film) {
  uint64_t rays = 0;
  for (size_t i = 0; i < film.tiles(); ++i) rays += film.tile(i).rays();
  return rays;
}

/// A channel's mean over the film and the standard error of that mean, from the pixels' own variances.
struct ChannelMean {
  double mean = 0, error = 0;
};

inline ChannelMean channel_mean(const Film& film, size_t channel) {
  const Crop& c = film.settings().crop;
  double sum = 0, variance = 0;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x) sum += film.mean(x, y)[channel], variance += film.variance(x, y)[channel];
  const double n = double(c.width()) * double(c.height());
  return {sum / n, std::sqrt(variance) / n};
}

}  // namespace frond::test
