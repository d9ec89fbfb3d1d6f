#pragma once

#include <functional>

#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/parallel.h"
#include "core/wavelengths.h"
#include "scene/film.h"

namespace frond {

/// The parts of one render. All of them are shared by the threads, none is changed.
struct RenderJob {
  const World& world;
  const Camera& camera;
  const Integrator& integrator;
  const WavelengthStrategy& wavelengths;
  const Filter& filter;
  const Sampler& sampler;
  uint64_t seed;
  uint64_t first_sample, samples;  ///< of each pixel
};

struct RenderStatistics {
  uint64_t paths = 0, rays = 0;
  double wall_seconds = 0, cpu_seconds = 0;
};

/// What has been done so far, told from one thread at a time.
using Progress = std::function<void(double fraction, const RenderStatistics&)>;

/// Adds the job's samples to the film. The film depends on the job alone, not on the threads.
RenderStatistics render(const RenderJob& job, Film& film, const ThreadPool& pool, const Progress& progress);

}  // namespace frond
