#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/parallel.h"
#include "core/wavelengths.h"
#include "render/film/film.h"
#include "render/progress.h"

namespace frond {

/// A pixel of the whole image.
struct PixelPosition {
  int x, y;
};

/// The parts of one render. All of them are shared by the threads, none is changed.
struct RenderJob {
  const World& world;
  const Camera& camera;
  const Integrator& integrator;
  const WavelengthStrategy& wavelengths;
  const Filter& filter;
  const Sampler& sampler;
  uint64_t seed;
  /// Which pixels of the image the film's stand for, row by row: some of them, drawn from all. Empty: themselves.
  /// Pixels that share samples stand for themselves.
  std::span<const PixelPosition> pixels = {};
  bool pixel_jitter = true;       ///< else all samples lie at the pixels' centres and the lens's, unfiltered
  bool wavelength_jitter = true;  ///< else they have the same wavelengths
};

/// Which samples of which of a film's pixels are to be rendered.
struct WorkPlan {
  Crop pixels;          ///< within those whose samples the film takes
  SampleRange samples;  ///< of each of them
  std::vector<uint64_t> tile_ends =
      {};  ///< by tile of the film, in place of the range's end; empty: everywhere the same
};

/// All pixels whose samples a film takes.
WorkPlan plan_of(const Film& film, SampleRange samples);

/// How a render is watched and ended. It ends between work items.
struct RenderControl {
  std::stop_token stop = {};
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  Progress* progress = nullptr;  ///< may be nullptr
};

/// Adds to the film what is planned and not in it yet. The film depends on job and plan alone, not on threads, nor on
/// what was there before it was begun or ended early. Says what this call took.
RenderStatistics render(const RenderJob& job, const WorkPlan& plan, Film& film, const ThreadPool& pool,
                        const RenderControl& control = {});

/// The film's exponent for images of this job: of the median over some paths' brightest responses. The same on every
/// machine; 0 where all of them are black.
int film_exponent(const RenderJob& job, const FilmSettings& settings);

}  // namespace frond
