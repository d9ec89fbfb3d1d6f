#include "render/render_loop.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>
#include <new>

#include "core/stop.h"
#include "scene/scene.h"

namespace frond {
namespace {

/// Divides a plan into work items, each a block of samples of a tile. The first blocks of all tiles come before the
/// second ones, so that an interrupted render has about the same number of samples everywhere.
class WorkItems {
 public:
  WorkItems(const WorkPlan& plan, const Film& film) : plan_(plan), film_(film) {
    // With so many paths in a block the cost of adding it to the film is negligible.
    constexpr uint64_t kLeastSamples = 16, kPaths = 4096;
    uint64_t pixels = 0;  // number of pixels in the largest tile; tiles at the edges of the image are smaller
    for (size_t i = 0; i < film.tiles(); ++i)
      pixels = std::max(pixels, uint64_t(film.tile_pixels(i).width() * film.tile_pixels(i).height()));
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

/// Items that are being rendered at the deadline may still be completed for this time: usually nothing is lost, and
/// slow tiles are not left out more often than others.
constexpr std::chrono::milliseconds kGrace{500};

/// State of one thread.
class Worker {
 public:
  Worker(const RenderInputs& job, const Film& film)
      : job_(job),
        wavelengths_(job.sampling.wavelengths),
        format_(film.format()),
        tracer_(job.integrator.tracer(job.world)),
        samples_(job.sampling, format_.splatting ? nullptr : &job.filter),
        bundle_(samples_.bundle()),
        tile_(film.format(), {}),
        axis_(job.sampling.camera
                  .ray({float(format_.settings.width) / 2, float(format_.settings.height) / 2}, {0.5f, 0.5f})
                  .d) {
    if (format_.splatting) kernel_.emplace(job.filter);
    if (format_.channels.has_albedo()) bundle_.albedo_samples = kAlbedoSamples;
  }

  /// Renders the samples of an item that `covered` lacks. Afterwards `tile` contains exactly these. Throws Stopped,
  /// with an incomplete tile, if a stop is requested: with a slow BSDF an item takes seconds.
  void render(const WorkItem& item, const Coverage& covered) {
    tile_.clear(item.empty() ? Crop{} : item.pixels);
    statistics_ = {};
    for (const WorkItem& missing : covered.missing(item)) {
      const Crop& pixels = missing.pixels;
      for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) render_pixel(x, y, missing.samples);
      tile_.cover(missing);
      statistics_.paths += missing.paths();
    }
  }
  const FilmTile& tile() const { return tile_; }
  const RenderStatistics& statistics() const { return statistics_; }

 private:
  /// Pixel of the image that a pixel of the film represents.
  PixelPosition image_pixel(int x, int y) const {
    const Crop& crop = format_.settings.crop;
    if (job_.pixels.empty()) return {x, y};
    return job_.pixels[size_t(y - crop.y0) * size_t(crop.width()) + size_t(x - crop.x0)];
  }

  void render_pixel(int x, int y, SampleRange samples) {
    const PixelPosition pixel = image_pixel(x, y);
    for (uint64_t first = samples.begin / kBundle * kBundle; first < samples.end; first += kBundle) {
      check_stop();
      const uint64_t begin = std::max(samples.begin, first), end = std::min(samples.end, first + kBundle);
      samples_.make(pixel, first, uint32_t(((1u << (end - first)) - 1) & ~((1u << (begin - first)) - 1)));
      tracer_->trace(bundle_);
      add_results(x, y, size_t(begin - first), size_t(end - first));
    }
    statistics_.rays += bundle_.traced;
    tile_.add_rays(bundle_.traced);
    bundle_.traced = 0;
  }

  Triple albedo(const FirstHit& first, const SampledWavelengths& lambda) const {
    if (!format_.has_colors()) return {};
    const Triple color = format_.color * wavelengths_.sensor(first.albedo, lambda).color();
    return {color[0] / format_.white[0], color[1] / format_.white[1], color[2] / format_.white[2]};
  }

  /// Radiance by bucket; wavelengths beyond the buckets are left out.
  SensorResponse bucket_response(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const {
    const auto [min, max] = format_.settings.buckets_nm;
    SensorResponse response;
    for (size_t i = 0; i < size_t(lambda.count); ++i) {
      const double nm = double(lambda.nm[i]), share = (nm - min) / (max - min);
      if (share < 0 || share > 1) continue;
      const auto lane = size_t(response.count++);
      response.value[lane] = double(radiance.v[i]);
      response.channel[lane] = uint16_t(std::min(size_t(share * double(format_.bands)), format_.bands - 1));
    }
    return response;
  }

  bool is_leaf(const FirstHit& first) const {
    return first.is_hit && first.material < job_.leaf_flags.size() && job_.leaf_flags[first.material];
  }

  /// Adds the results `begin` to `end - 1` of the bundle to the tile.
  void add_results(int x, int y, size_t begin, size_t end) {
    const bool has_channels = format_.channels.means() + format_.channels.ids() > 0;
    const bool has_mattes = format_.channels.mattes() > 0, has_buckets = format_.has_buckets();
    for (size_t i = begin; i < end; ++i) {
      const PathResult& path = bundle_.results[i];
      const SampledWavelengths& lambda = bundle_.lambda[i];
      const auto& [offset, weight] = samples_.position(i);
      // No radiance gives no response: the conversion is linear.
      const bool is_black = format_.has_colors() && path.radiance.is_black();
      ::new (&film_samples_[i]) FilmTile::Sample{
          is_black ? SensorResponse(std::array<double, 3>{}) : wavelengths_.sensor(path.radiance, lambda),
          double(weight),
          is_leaf(path.first),
          {offset.x + 0.5f, offset.y + 0.5f}};
      if (has_buckets)
        bucket_samples_[i] = {bucket_response(path.radiance, lambda), double(weight), false, film_samples_[i].place};
      if (path.first.is_hit && has_channels) {
        Features features(format_.channels, {path.first, bundle_.rays[i], axis_, albedo(path.first, lambda)});
        features.from_center = std::hypot(offset.x, offset.y), features.sample = bundle_.samples.first + i;
        tile_.add(x, y, features);
      }
      if (has_mattes) {
        mattes_[i] = {{}, double(weight), {offset.x + 0.5f, offset.y + 0.5f}};
        if (path.first.is_hit) mattes_[i].keys = format_.channels.matte_keys({path.first, bundle_.rays[i], axis_, {}});
      }
      statistics_.ends.add(path);
      if (path.fault.kind != PlugInFault::Kind::none) ++statistics_.faults[path.fault];
    }
    const SplatKernel* kernel = kernel_ ? &*kernel_ : nullptr;
    tile_.add(format_, x, y, std::span(film_samples_).subspan(begin, end - begin), kernel);
    if (has_buckets) tile_.add_buckets(format_, x, y, std::span(bucket_samples_).subspan(begin, end - begin), kernel);
    if (has_mattes) tile_.add_mattes(x, y, std::span(mattes_).subspan(begin, end - begin), kernel);
  }

  static constexpr uint32_t kBundle = PathBundle::kSize;
  /// As in pbrt-v4. With one sample, the path's own, the noise of the albedo would be correlated with the noise of the
  /// colours, and a denoiser would take it for structure.
  static constexpr int kAlbedoSamples = 16;

  const RenderInputs& job_;
  const WavelengthStrategy& wavelengths_;
  const FilmFormat& format_;
  std::optional<SplatKernel> kernel_;  ///< set with splatting
  std::unique_ptr<Tracer> tracer_;
  CameraSamples samples_;
  PathBundle& bundle_;  ///< of samples_
  std::array<FilmTile::Sample, kBundle> film_samples_, bucket_samples_;
  std::array<MatteSample, kBundle> mattes_;
  FilmTile tile_;
  Vec3 axis_;  ///< viewing direction, along which depth is measured
  RenderStatistics statistics_;
};

}  // namespace

RenderInputs job_of(const Scene& scene, const Integrator& integrator, const Sampler& sampler) {
  return {.world = scene,
          .integrator = integrator,
          .filter = scene.filter(),
          .sampling = scene.camera_sampling(sampler),
          .leaf_flags = scene.leaf_flags()};
}

RenderInputs job_of(const Scene& scene) { return job_of(scene, scene.integrator(), scene.sampler()); }

WorkPlan plan_of(const Film& film, SampleRange samples) { return {film.sampled(), samples}; }

RenderStatistics render(const RenderInputs& job, const WorkPlan& plan, Film& film, const ThreadPool& pool,
                        const RenderControl& control) {
  const RenderTimer timer;
  const StopScope stop(control.stop);
  const DeadlineScope deadline(control.deadline ? std::optional(*control.deadline + kGrace) : std::nullopt);
  const WorkItems items(plan, film);
  std::vector<std::unique_ptr<Worker>> workers(size_t(pool.size()));
  RenderStatistics total;
  std::mutex mutex;
  int64_t done = 0;
  const auto render_item = [&](int64_t i, int thread) {
    if (control.is_over()) throw Stopped();  // ends the loop over all items, which may be millions
    auto& worker = workers[size_t(thread)];
    if (!worker) worker = std::make_unique<Worker>(job, film);
    // No other thread adds samples of this item: its missing samples remain the same meanwhile.
    worker->render(items.item(i), film.coverage(items.tile(i)));
    film.merge(items.tile(i), worker->tile());
    const std::lock_guard lock(mutex);
    ++done;
    if (worker->statistics().paths == 0) return;
    total += worker->statistics();
    timer.read(total);
    if (control.progress) control.progress->update(double(done) / double(items.count()), total);
  };
  try {
    pool.for_each(items.count(), render_item);
  } catch (const Stopped&) {  // the film contains all completed items, and nothing of the others
    if (!control.is_over()) throw;
  }
  timer.read(total);
  if (control.progress) control.progress->finish();
  return total;
}

int film_exponent(const RenderInputs& job, double exposure) {
  constexpr uint64_t kPaths = 256;
  const auto tracer = job.integrator.tracer(job.world);
  CameraSamples samples(job.sampling, nullptr);
  PathBundle& bundle = samples.bundle();
  std::vector<double> brightest;
  for (uint64_t i = 0; i < kPaths; ++i) {
    check_stop();
    const size_t lane = i % PathBundle::kSize;
    samples.make(job.sampling.random_pixel(i), i - lane, 1u << lane);
    tracer->trace(bundle);
    const SensorResponse r = job.sampling.wavelengths.sensor(bundle.results[lane].radiance, bundle.lambda[lane]);
    const double value = std::max({r[0], r[1], r[2], r[3]}) * exposure;
    if (value > 0 && std::isfinite(value)) brightest.push_back(value);
  }
  if (brightest.empty()) return 0;
  std::ranges::nth_element(brightest, brightest.begin() + ptrdiff_t(brightest.size() / 2));
  constexpr int kMost = 400;  // keeps the square of the unit finite and above 0
  return std::clamp(std::ilogb(brightest[brightest.size() / 2]), -kMost, kMost);
}

}  // namespace frond
