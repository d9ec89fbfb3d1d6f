#include "integrators/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "core/cpu_clock.h"

namespace frond {
namespace {

constexpr int kTile = 16;

class Clock {
 public:
  void stop(RenderStatistics& s) const {
    s.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    s.cpu_seconds = cpu_seconds() - cpu_;
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = cpu_seconds();
};

/// What one thread works with.
struct Worker {
  std::unique_ptr<Sampler> sampler;
  Arena arena;
  uint64_t rays = 0;
  PathEnds ends;
};

PixelPlace place_of(const RenderJob& job, const Crop& crop, int x, int y) {
  if (job.places.empty()) return {x, y};
  return job.places[size_t(y - crop.y0) * size_t(crop.width()) + size_t(x - crop.x0)];
}

/// Renders one sample of one pixel.
void render_sample(const RenderJob& job, Film& film, Worker& worker, int x, int y, uint64_t index) {
  Sampler& sampler = *worker.sampler;
  const PixelPlace at = place_of(job, film.settings().crop, x, y);
  sampler.start(at.x, at.y, index);
  const SampledWavelengths lambda = job.wavelengths.sample_in_turn(index, sampler.get1d());
  const auto [offset, weight] = job.filter.sample(sampler.get2d());
  const Vec2 film_point{float(at.x) + 0.5f + offset.x, float(at.y) + 0.5f + offset.y};
  const Ray ray = job.camera.ray(film_point, job.camera.uses_lens() ? sampler.get2d() : Vec2{});
  PathContext context{sampler, sample_key(job.seed, at.x, at.y, index), worker.arena};
  const PathResult path = job.integrator.trace(job.world, ray, lambda, context);
  film.add(x, y, job.wavelengths.sensor(path.radiance, lambda), double(weight), path.sees_leaf);
  worker.rays += context.rays;
  worker.ends.add(path);
}

struct Tiles {
  Crop crop;
  int64_t columns, rows;

  explicit Tiles(const Crop& c)
      : crop(c), columns((c.width() + kTile - 1) / kTile), rows((c.height() + kTile - 1) / kTile) {}
  int64_t count() const { return columns * rows; }
  Crop at(int64_t i) const {
    const int x = crop.x0 + int(i % columns) * kTile, y = crop.y0 + int(i / columns) * kTile;
    return {x, y, std::min(x + kTile, crop.x1), std::min(y + kTile, crop.y1)};
  }
};

}  // namespace

RenderStatistics render(const RenderJob& job, Film& film, const ThreadPool& pool, const Progress& progress) {
  const Clock clock;
  const Tiles tiles(film.settings().crop);
  std::vector<Worker> workers(size_t(pool.size()));
  for (Worker& worker : workers) worker.sampler = job.sampler.clone();
  RenderStatistics total;
  std::mutex mutex;
  int64_t done = 0;
  pool.for_each(tiles.count(), [&](int64_t i, int thread) {
    const Crop tile = tiles.at(i);
    Worker& worker = workers[size_t(thread)];
    worker.rays = 0;
    worker.ends = {};
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        for (uint64_t s = 0; s < job.samples; ++s) render_sample(job, film, worker, x, y, job.first_sample + s);
    const std::lock_guard lock(mutex);
    total.rays += worker.rays;
    total.ends += worker.ends;
    total.paths += uint64_t(tile.width()) * uint64_t(tile.height()) * job.samples;
    clock.stop(total);
    if (progress) progress(double(++done) / double(tiles.count()), total);
  });
  clock.stop(total);
  return total;
}

}  // namespace frond
