#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/math/motion.h"
#include "core/parallel.h"
#include "core/wavelengths.h"
#include "render/film/film.h"
#include "render/progress.h"

namespace frond {

class Scene;

/// Pixel coordinates in the whole image.
struct PixelPosition {
  int x, y;
};

/// Components of a render. The threads share them and do not modify them.
struct RenderJob {
  const World& world;
  const Camera& camera;
  const Integrator& integrator;
  const WavelengthStrategy& wavelengths;
  const Filter& filter;
  const Sampler& sampler;
  uint64_t seed;
  /// Pixels of the image that the film's pixels represent, row by row, for a film that holds a random subset of an
  /// image; empty: the film's own pixels. It must be empty with splatting.
  std::span<const PixelPosition> pixels = {};
  bool pixel_jitter = true;       ///< false: all samples at the centres of the pixel and of the lens, unfiltered
  bool wavelength_jitter = true;  ///< false: all samples have the same wavelengths
  bool has_motion = false;        ///< rays need a time
  const CameraMotion* camera_motion = nullptr;  ///< nullptr: the camera stands still
  std::span<const uint8_t> leaf_flags = {};  ///< by SurfacePoint::material_id: whether hits count as leaf; empty: none
};

/// A render of a scene as it is described. The scene must outlive the job.
RenderJob job_of(const Scene& scene);
/// The same with another integrator, or other random numbers; these must outlive the job too.
RenderJob job_of(const Scene& scene, const Integrator& integrator, const Sampler& sampler, uint64_t seed);

/// Samples to render: a range of sample indices for a rectangle of pixels.
struct WorkPlan {
  Crop pixels;          ///< inside Film::sampled
  SampleRange samples;  ///< sample indices of each pixel
  std::vector<uint64_t> tile_ends =
      {};  ///< end of the sample indices for each tile of the film; replaces samples.end if not empty
};

/// Plan of these samples for all pixels of Film::sampled.
WorkPlan plan_of(const Film& film, SampleRange samples);

/// Observer of a render, and conditions that end it early. A render ends between work items: what of an item has been
/// traced when a stop is requested does not count. At the deadline, items that have begun may take half a second more.
struct RenderControl {
  std::stop_token stop = {};
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  Progress* progress = nullptr;  ///< may be nullptr

  bool is_over() const { return stop.stop_requested() || (deadline && std::chrono::steady_clock::now() >= *deadline); }
};

/// Renders all samples of the plan that the film does not contain, and adds them to the film. The resulting film
/// depends only on job and plan, not on the number of threads or on interruptions. Returns the statistics of this call.
RenderStatistics render(const RenderJob& job, const WorkPlan& plan, Film& film, const ThreadPool& pool,
                        const RenderControl& control = {});

/// Value of FilmFormat::exponent for a job: the exponent of the median, over 256 paths, of the largest component of the
/// sensor's response; 0 if all paths are black. It is the same on every machine.
int film_exponent(const RenderJob& job, const FilmSettings& settings);

}  // namespace frond
