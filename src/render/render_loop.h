#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "core/camera_samples.h"
#include "core/parallel.h"
#include "render/film/film.h"
#include "render/progress.h"
#include "system/machine.h"

namespace frond {

class Scene;

/// Components of a render. The threads share them and do not modify them.
struct RenderInputs {
  const World& world;
  const Integrator& integrator;
  const Filter& filter;
  CameraSampling sampling;
  /// Pixels of the image that the film's pixels represent, row by row, for a film that holds a random subset of an
  /// image; empty: the film's own pixels. It must be empty with splatting.
  std::span<const PixelPosition> pixels = {};
  std::span<const uint8_t> leaf_flags = {};  ///< by SurfacePoint::material_id: whether hits count as leaf; empty: none
};

/// Job of a scene with its own integrator and sampler. The scene must outlive the job.
RenderInputs job_of(const Scene& scene);
/// The same with another integrator or sampler, which must outlive the job too.
RenderInputs job_of(const Scene& scene, const Integrator& integrator, const Sampler& sampler);

/// Samples to render: a range of sample indices for a rectangle of pixels.
struct WorkPlan {
  Crop pixels;          ///< inside Film::sampled
  SampleRange samples;  ///< sample indices of each pixel
  std::vector<uint64_t> tile_ends =
      {};  ///< end of the sample indices for each tile of the film; replaces samples.end if not empty
};

/// Plan of these samples for all pixels of Film::sampled.
WorkPlan plan_of(const Film& film, SampleRange samples);

/// Observer of a render, and conditions that end it early. A render ends between work items: if a stop is requested,
/// the paths of an incomplete item do not count. At the deadline, items that have begun may take half a second more.
struct RenderControl {
  std::stop_token stop = {};
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  Progress* progress = nullptr;  ///< may be nullptr

  bool is_over() const { return stop.stop_requested() || (deadline && std::chrono::steady_clock::now() >= *deadline); }
};

/// Times since its construction.
class RenderTimer {
 public:
  void read(RenderStatistics& s) const {
    s.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    s.cpu_seconds = cpu_seconds() - cpu_;
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = cpu_seconds();
};

/// Renders all samples of the plan that the film does not contain, and adds them to the film. The resulting film
/// depends only on job and plan, not on the number of threads or on interruptions. Returns the statistics of this call.
RenderStatistics render(const RenderInputs& job, const WorkPlan& plan, Film& film, const ThreadPool& pool,
                        const RenderControl& control = {});

/// Value of FilmFormat::exponent for a job: the exponent of the median, over one path in each of 256 pixels, of the
/// largest component of the sensor's response times `exposure`; 0 if all paths are black. It is the same on every
/// machine.
int film_exponent(const RenderInputs& job, double exposure);

}  // namespace frond
