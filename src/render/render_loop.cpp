#include "render/render_loop.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>

#include "system/cpu_clock.h"

namespace frond {
namespace {

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

/// Cuts a plan into work items: the samples of a tile in blocks, all tiles' first blocks before all tiles' second, so
/// that whatever ends a render early leaves a picture that is finished to the same degree everywhere.
class WorkItems {
 public:
  WorkItems(const WorkPlan& plan, const Film& film) : plan_(plan), film_(film) {
    // Enough paths in a block that what it costs to add it to the film is nothing beside them.
    constexpr uint64_t kLeastSamples = 16, kPaths = 4096;
    const auto pixels = uint64_t(film.tile_pixels(0).width() * film.tile_pixels(0).height());
    block_ = std::max(kLeastSamples, std::bit_floor(kPaths / std::min(kPaths, pixels)));
    first_block_ = plan.samples.begin / block_;
    uint64_t end = plan.tile_ends.empty() ? plan.samples.end : 0;
    for (const uint64_t tile_end : plan.tile_ends) end = std::max(end, tile_end);
    blocks_ = (end + block_ - 1) / block_ - std::min((end + block_ - 1) / block_, first_block_);
  }
  int64_t count() const { return int64_t(blocks_ * film_.tiles()); }
  size_t tile(int64_t i) const { return size_t(i) % film_.tiles(); }
  /// May be empty.
  WorkItem item(int64_t i) const {
    const uint64_t block = first_block_ + uint64_t(i) / film_.tiles();
    const uint64_t end = plan_.tile_ends.empty() ? plan_.samples.end : plan_.tile_ends[tile(i)];
    const WorkItem whole{film_.tile_pixels(tile(i)), {block * block_, (block + 1) * block_}};
    return intersection(whole, {plan_.pixels, {plan_.samples.begin, end}});
  }

 private:
  const WorkPlan& plan_;
  const Film& film_;
  uint64_t block_, first_block_, blocks_;
};

/// What one thread works with.
class Worker {
 public:
  Worker(const RenderJob& job, const Film& film)
      : job_(job),
        format_(film.format()),
        sampler_(job.sampler.clone()),
        tile_(film.format(), {}),
        axis_(job.camera.ray({float(format_.settings.width) / 2, float(format_.settings.height) / 2}, {0.5f, 0.5f}).d) {
  }

  /// Renders an item, all that it has not got yet. It is then what `tile` holds.
  void render(const WorkItem& item, const Coverage& covered) {
    tile_.clear(item.pixels);
    statistics_ = {};
    for (const WorkItem& piece : covered.missing(item)) {
      for (int y = piece.pixels.y0; y < piece.pixels.y1; ++y)
        for (int x = piece.pixels.x0; x < piece.pixels.x1; ++x) render_pixel(x, y, piece.samples);
      tile_.cover(piece);
      statistics_.paths += piece.paths();
    }
  }
  const FilmTile& tile() const { return tile_; }
  const RenderStatistics& statistics() const { return statistics_; }

 private:
  PixelPlace place_of(int x, int y) const {
    const Crop& crop = format_.settings.crop;
    if (job_.places.empty()) return {x, y};
    return job_.places[size_t(y - crop.y0) * size_t(crop.width()) + size_t(x - crop.x0)];
  }

  void render_pixel(int x, int y, SampleRange samples) {
    if (!format_.blocks) {
      for (uint64_t s = samples.begin; s < samples.end; ++s) render_sample(x, y, s);
      return;
    }
    assert(samples.begin % FilmTile::kBlock == 0 && samples.end % FilmTile::kBlock == 0);
    for (uint64_t s = samples.begin; s < samples.end;) {
      const FilmTile::Pixel before = tile_.pixel(x, y);
      for (const uint64_t end = s + FilmTile::kBlock; s < end; ++s) render_sample(x, y, s);
      tile_.add_block(x, y, before);
    }
  }

  Triple albedo(const FirstHit& first, const SampledWavelengths& lambda) const {
    if (format_.bands > 0) return {};
    const Triple color = format_.color * job_.wavelengths.sensor(first.albedo, lambda).color();
    return {color[0] / format_.white[0], color[1] / format_.white[1], color[2] / format_.white[2]};
  }

  void render_sample(int x, int y, uint64_t index) {
    const PixelPlace at = place_of(x, y);
    sampler_->start(at.x, at.y, index);
    const SampledWavelengths lambda = job_.wavelengths.sample_in_turn(index, sampler_->get1d());
    const auto [offset, weight] = job_.filter.sample(sampler_->get2d());
    const Vec2 film_point{float(at.x) + 0.5f + offset.x, float(at.y) + 0.5f + offset.y};
    const Ray ray = job_.camera.ray(film_point, job_.camera.uses_lens() ? sampler_->get2d() : Vec2{});
    PathContext context{*sampler_, sample_key(job_.seed, at.x, at.y, index), arena_};
    const PathResult path = job_.integrator.trace(job_.world, ray, lambda, context);
    tile_.add(format_, x, y, job_.wavelengths.sensor(path.radiance, lambda), double(weight), path.first.is_leaf);
    if (path.first.is_hit && format_.channels.means() + format_.channels.ids() > 0) {
      Features features(format_.channels, {path.first, ray, axis_, albedo(path.first, lambda)});
      features.from_center = std::hypot(offset.x, offset.y), features.sample = index;
      tile_.add(x, y, features);
    }
    statistics_.rays += context.rays;
    tile_.add_rays(context.rays);
    statistics_.ends.add(path);
  }

  const RenderJob& job_;
  const FilmFormat& format_;
  std::unique_ptr<Sampler> sampler_;
  Arena arena_;
  FilmTile tile_;
  Vec3 axis_;  ///< along which depth is measured
  RenderStatistics statistics_;
};

}  // namespace

WorkPlan plan_of(const Film& film, SampleRange samples) { return {film.settings().crop, samples}; }

RenderStatistics render(const RenderJob& job, const WorkPlan& plan, Film& film, const ThreadPool& pool,
                        const RenderControl& control) {
  const Clock clock;
  const WorkItems items(plan, film);
  std::vector<std::unique_ptr<Worker>> workers(size_t(pool.size()));
  RenderStatistics total;
  std::mutex mutex;
  int64_t done = 0;
  std::atomic<bool> ended = false;
  pool.for_each(items.count(), [&](int64_t i, int thread) {
    if (ended) return;
    if (control.stop.stop_requested() || (control.deadline && std::chrono::steady_clock::now() >= *control.deadline)) {
      ended = true;
      return;
    }
    auto& worker = workers[size_t(thread)];
    if (!worker) worker = std::make_unique<Worker>(job, film);
    // No other thread adds any of this item, so that what is missing of it stays the same.
    worker->render(items.item(i), film.coverage(items.tile(i)));
    film.merge(items.tile(i), worker->tile());
    const std::lock_guard lock(mutex);
    ++done;
    if (worker->statistics().paths == 0) return;
    total += worker->statistics();
    clock.stop(total);
    if (control.progress) control.progress->update(double(done) / double(items.count()), total);
  });
  clock.stop(total);
  if (control.progress) control.progress->finish();
  return total;
}

int film_exponent(const RenderJob& job, const FilmSettings& settings) {
  constexpr uint64_t kPaths = 256;
  const auto sampler = job.sampler.clone();
  Arena arena;
  std::vector<double> brightest;
  for (uint64_t i = 0; i < kPaths; ++i) {
    RandomStream place(hash_key(job.seed, i));
    const int x = int(place.uniform() * float(settings.width)), y = int(place.uniform() * float(settings.height));
    sampler->start(x, y, i);
    const SampledWavelengths lambda = job.wavelengths.sample_in_turn(i, sampler->get1d());
    const Ray ray = job.camera.ray({float(x) + 0.5f, float(y) + 0.5f}, {0.5f, 0.5f});
    PathContext context{*sampler, sample_key(job.seed, x, y, i), arena};
    const SensorResponse r =
        job.wavelengths.sensor(job.integrator.trace(job.world, ray, lambda, context).radiance, lambda);
    const double value = std::max({r[0], r[1], r[2], r[3]}) * settings.exposure;
    if (value > 0 && std::isfinite(value)) brightest.push_back(value);
  }
  if (brightest.empty()) return 0;
  std::ranges::nth_element(brightest, brightest.begin() + ptrdiff_t(brightest.size() / 2));
  constexpr int kMost = 400;  // so that squares of units are numbers
  return std::clamp(std::ilogb(brightest[brightest.size() / 2]), -kMost, kMost);
}

}  // namespace frond
