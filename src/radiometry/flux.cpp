#include "radiometry/flux.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numbers>

#include "core/math/random.h"
#include "core/math/sampling.h"
#include "core/stop.h"
#include "radiometry/lit_bands.h"
#include "radiometry/radiometer_scene.h"
#include "radiometry/sums_file.h"
#include "system/machine.h"

namespace frond {
namespace {

using Lanes = SampledSpectrum;

/// Index of a quantity in a path's row. Three quantities for each material follow.
enum Quantity : size_t { kReflected, kTransmitted, kTotal, kFirstOfMaterials };
enum OfMaterial : size_t { kAbsorbed, kIncident, kUncollided, kQuantitiesOfMaterial };

/// Record of one path: shares of the incident light by quantity and lane.
class PathRecord {
 public:
  explicit PathRecord(size_t quantities) : values_(quantities) {}
  void clear() {
    std::ranges::fill(values_, Lanes());
    by_instance_.clear();
  }
  void add(size_t quantity, const Lanes& share) { values_[quantity] += share; }
  /// Adds light that leaves the scene.
  void leave(size_t quantity, const Lanes& share) {
    add(quantity, share);
    add(kTotal, share);
  }
  void absorb(uint32_t material, uint64_t instance, const Lanes& share) {
    leave(of_material(material, kAbsorbed), share);
    if (instance == 0) return;
    const auto known = std::ranges::find(by_instance_, instance, &std::pair<uint64_t, Lanes>::first);
    if (known == by_instance_.end())
      by_instance_.emplace_back(instance, share);
    else
      known->second += share;
  }
  static size_t of_material(uint32_t material, OfMaterial what) {
    return kFirstOfMaterials + material * kQuantitiesOfMaterial + what;
  }
  const std::vector<Lanes>& values() const { return values_; }
  const std::vector<std::pair<uint64_t, Lanes>>& by_instance() const { return by_instance_; }

 private:
  std::vector<Lanes> values_;
  std::vector<std::pair<uint64_t, Lanes>> by_instance_;
};

/// Sum and sum of squares over paths.
struct Moment {
  double sum = 0, square = 0;
  void add(double x) { sum += x, square += x * x; }
  Moment& operator+=(const Moment& other) {
    sum += other.sum, square += other.square;
    return *this;
  }
  MeanError share(uint64_t paths) const {
    const auto n = double(paths);
    if (paths == 0) return {};
    const double mean = sum / n, variance = std::max(0.0, square / n - mean * mean);
    return {mean, paths > 1 ? std::sqrt(variance / (n - 1)) : 0};
  }
};

/// Moments of instances, which all threads add to. They are integers, so that the sum does not depend on the order.
class InstanceSums {
 public:
  InstanceSums(uint64_t instances, size_t bands) : bands_(bands), cells_(instances * bands) {}
  void add(uint64_t instance, size_t band, double share) {
    Cell& cell = cells_[(instance - 1) * bands_ + band];
    std::atomic_ref(cell.sum).fetch_add(std::llrint(share * kUnits), std::memory_order_relaxed);
    std::atomic_ref(cell.square).fetch_add(std::llrint(share * share * kUnits), std::memory_order_relaxed);
  }
  size_t size() const { return cells_.size(); }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
  Moment at(size_t cell) const { return {double(cells_[cell].sum) / kUnits, double(cells_[cell].square) / kUnits}; }

  static constexpr size_t kCellBytes = 16;

 private:
  static constexpr double kUnits = 0x1p36;
  struct Cell {
    int64_t sum = 0, square = 0;
  };
  size_t bands_;
  std::vector<Cell> cells_;
};

/// Samples the incident light: a direction of one of the lights, and a weight.
class Incoming {
 public:
  /// `lambda`: wavelengths at which the scene has light.
  Incoming(const Scene& scene, HorizontalIrradiance irradiance, const SampledWavelengths& lambda)
      : lights_(scene.lights()), irradiance_(std::move(irradiance)) {
    for (const Light* light : lights_) {
      const auto* sky = dynamic_cast<const EnvironmentLight*>(light);
      evenly_.push_back(sky && varies_less_by_cosine(*light, lambda) ? sky : nullptr);
    }
  }

  struct Sample {
    Vec3 direction;  ///< direction of propagation, downward
    Lanes weight;    ///< mean 1
  };
  std::optional<Sample> sample(RandomStream& random, const SampledWavelengths& lambda) const {
    const std::vector<double>& shares = irradiance_.shares();
    double choice = random.uniform_double();
    size_t i = 0;
    while (i + 1 < shares.size() && choice >= shares[i]) choice -= shares[i++];
    const auto s = sample_one(*lights_[i], evenly_[i], {random.uniform(), random.uniform()}, lambda);
    if (!s) return {};
    Lanes weight;
    const Lanes irradiance = irradiance_.at(lambda);
    for (int lane = 0; lane < lambda.count; ++lane)
      if (irradiance[lane] > 0) weight[lane] = s->weight[lane] / (float(shares[i]) * irradiance[lane]);
    return Sample{s->direction, weight};
  }

 private:
  /// Cosine below which light is left out: its ray would begin far from the scene, or nowhere. Of a uniform sky this is
  /// 1e-12 of the light, of a cosine that is rounded to 0 about 1e-7.
  static constexpr float kGrazing = 1e-6f;

  /// Weight relative to the irradiance of all lights. Directions of a uniform sky are sampled with the cosine.
  static std::optional<Sample> sample_one(const Light& light, const EnvironmentLight* evenly, Vec2 u,
                                          const SampledWavelengths& lambda) {
    if (evenly) {
      const Vec3 wi = sample_cosine_hemisphere(u);
      if (wi.z < kGrazing) return {};
      return Sample{-wi, evenly->radiance({}, wi, lambda) * kPi};
    }
    const auto s = light.sample({}, u, lambda);
    if (!s || s->wi.z < kGrazing || s->pdf <= 0) return {};
    return Sample{-s->wi, s->radiance * (s->wi.z / s->pdf)};
  }

  /// Returns whether the weights of directions sampled with the cosine have less variance than those of the light's own
  /// samples. Both second moments, of the same mean, are estimated from the light's samples: directions sampled with
  /// the cosine would hardly ever find a sun, and show less variance than they have.
  static bool varies_less_by_cosine(const Light& light, const SampledWavelengths& lambda) {
    constexpr int kPoints = 4096;
    RandomStream random(1);
    double by_cosine = 0, own = 0;
    for (int i = 0; i < kPoints; ++i) {
      const auto s = light.sample({}, {random.uniform(), random.uniform()}, lambda);
      if (!s || s->wi.z < kGrazing || s->pdf <= 0) continue;
      const double radiance = double(s->radiance[0]), weight = radiance * double(s->wi.z) / double(s->pdf);
      by_cosine += weight * radiance * std::numbers::pi;
      own += weight * weight;
    }
    return by_cosine < own;
  }

  std::span<const Light* const> lights_;
  std::vector<const EnvironmentLight*> evenly_;  ///< sampled with the cosine, where that has less variance
  HorizontalIrradiance irradiance_;
};

/// Returns the materials of surfaces, without those that have none, as "interface".
std::vector<uint32_t> reflectors_of(const Scene& scene) {
  const SampledWavelengths lambda = scene.wavelengths().sample(0.5f);
  const Hit hit{.p = {}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}, {}}};
  std::vector<uint32_t> materials = scene.geometry().materials();
  std::erase_if(materials, [&](uint32_t m) {
    Arena arena;
    return !scene.material(m) || !scene.material(m)->evaluate(hit, lambda, arena);
  });
  return materials;
}

Lanes remainder(const Lanes& weight) {
  Lanes rest;
  for (int lane = 0; lane < kLanes; ++lane) rest[lane] = 1 - weight[lane];
  return rest;
}

}  // namespace

struct FluxMeter::State {
  LoadedScene loaded;
  Target target;
  Incoming incoming;
  LitBands wavelengths;
  size_t materials, bands;
  std::vector<uint32_t> reflectors = {};  ///< indices of the materials of surfaces that light can meet
  std::vector<Moment> moments = {};       ///< by quantity and band
  std::vector<uint64_t> seen = {};        ///< number of paths, by band
  std::unique_ptr<InstanceSums> by_instance = {};
  uint64_t paths = 0;

  size_t quantities() const { return kFirstOfMaterials + materials * kQuantitiesOfMaterial; }
  const Scene& scene() const { return loaded.scene(); }
  /// Returns all accumulators as bytes, for save and resume.
  std::vector<std::span<std::byte>> sums() {
    std::vector<std::span<std::byte>> arrays{std::as_writable_bytes(std::span(&paths, 1)),
                                             std::as_writable_bytes(std::span(moments)),
                                             std::as_writable_bytes(std::span(seen))};
    if (by_instance) arrays.push_back(by_instance->bytes());
    return arrays;
  }
};

/// Accumulators of one block of paths.
class FluxMeter::Sums {
 public:
  static constexpr uint64_t kBlock = 1024;

  explicit Sums(State& state)
      : state_(state), record_(state.quantities()), moments(state.quantities() * state.bands), seen(state.bands) {}

  void trace(uint64_t first, uint64_t count) {
    const WavelengthStrategy& wavelengths = state_.scene().wavelengths();
    constexpr uint64_t kPolled = 16;  // paths
    for (uint64_t i = first; i < first + count; ++i) {
      if (i % kPolled == 0) check_stop();
      RandomStream random(hash_key(state_.scene().seed(), uint64_t{kStream}, i));
      const SampledWavelengths lambda = state_.wavelengths.sample_for_index(i, random.uniform());
      record_.clear();
      follow(lambda, hash_key(state_.scene().seed(), uint64_t{kKeys}, i), random);
      for (size_t q = 0; q < record_.values().size(); ++q) {
        const SensorResponse response = wavelengths.sensor(record_.values()[q], lambda);
        for (size_t k = 0; k < size_t(response.count); ++k)
          moments[q * state_.bands + response.channel[k]].add(response.value[k]);
      }
      for (int lane = 0; lane < lambda.count; ++lane) ++seen[lambda.band[size_t(lane)]];
      if (!state_.by_instance) continue;
      for (const auto& [instance, share] : record_.by_instance())
        for (size_t lane = 0; lane < size_t(lambda.count); ++lane)
          absorbed_.push_back({instance, lambda.band[lane], double(share.v[lane])});
    }
  }
  /// Adds to the sums of instances, which have no block of their own: once the block counts.
  void add_instances() {
    for (const Absorbed& a : absorbed_) state_.by_instance->add(a.instance, a.band, a.share);
    absorbed_ = {};
  }

 private:
  enum Use : uint64_t { kStream = 0x666c7578, kKeys };

  void follow(SampledWavelengths lambda, uint64_t key, RandomStream& random) {
    constexpr int kMostPassed = 1000, kFirstRoulette = 3;
    constexpr float kFull = 0.25f;  // share of the incident light below which Russian roulette may end a path
    const Target& t = state_.target;
    const Vec2 u{random.uniform(), random.uniform()};
    const auto light = state_.incoming.sample(random, lambda);
    if (!light) return;
    const Vec3d on_target{std::lerp(t.x0, t.x1, double(u.x)), std::lerp(t.y0, t.y1, double(u.y)), t.z};
    const Vec3d d = to_double(light->direction);
    const Scene& scene = state_.scene();
    Ray ray{to_float(on_target - d * distance_above(scene, t, -d.z) - scene.origin()), light->direction};
    Lanes share = light->weight;
    const float full = kFull * share.max();
    constexpr int kPolled = 256;
    for (int vertex = 0, depth = 0; vertex - depth <= kMostPassed; ++vertex) {
      if (vertex % kPolled == kPolled - 1) check_stop();
      SurfacePoint point;
      if (!state_.scene().intersect(ray, hash_key(key, uint64_t(vertex)), point)) {
        record_.leave(ray.d.z > 0 ? kReflected : kTransmitted, share);
        return;
      }
      arena_.reset();
      const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, arena_);
      if (!bsdf) {
        ray = {offset_origin(point.hit, ray.d), ray.d};
        continue;
      }
      record_.add(PathRecord::of_material(point.material_id, kIncident), share);
      if (depth++ == 0) record_.add(PathRecord::of_material(point.material_id, kUncollided), share);
      const auto [direction, weight] = scatter(*bsdf, point.hit, ray.d, random);
      if (!weight.is_physical()) fail_for(point.material_id);
      record_.absorb(point.material_id, point.instance_id, share * remainder(weight));
      share *= weight;
      lambda.retire_black_lanes(share);
      if (share.is_black()) return;
      if (depth >= kFirstRoulette && share.max() < full) {
        if (random.uniform() * full >= share.max()) return;
        share *= full / share.max();
      }
      ray = {offset_origin(point.hit, direction), direction};
    }
  }

  [[noreturn]] void fail_for(uint32_t material) const {
    const MaterialDescription& m = state_.loaded.description().materials[material];
    fail(m.plugin.where, "{} has a defect: it scatters weights that are negative, infinite or not a number",
         spelled(m));
  }

  struct Onward {
    Vec3 direction;
    Lanes weight;
  };
  /// Scatters light that travels along `d`. The shading normal alone decides on which side a direction is.
  static Onward scatter(const Bsdf& bsdf, const Hit& hit, const Vec3& d, RandomStream& random) {
    const Frame& frame = hit.shading;
    Scattered s;
    bsdf.scatter(frame.to_local(-d), random, {&s, 1});
    if (s.weight.is_black()) return {};
    constexpr float kRounding = 1e-2f;
    if (!(std::abs(dot(s.direction, s.direction) - 1) < kRounding)) return {{}, Lanes(NAN)};
    return {frame.to_world(s.direction), s.weight};
  }

  struct Absorbed {
    uint64_t instance;
    size_t band;
    double share;
  };

  State& state_;
  Arena arena_;
  PathRecord record_;
  std::vector<Absorbed> absorbed_;

 public:
  std::vector<Moment> moments;
  std::vector<uint64_t> seen;
};

FluxMeter::FluxMeter(Session& session, SceneDescription description, const FluxRequest& request) {
  if (description.has_media())
    fail(description.media.front().plugin.where,
         "flux does not trace participating media; brf and render do, by integrator \"volpath\"");
  prepare_for_radiometry(session.registry(), request.wavelengths, request.period, false, description);
  std::string what = request.by_instance ? "flux by instance" : "flux";
  if (request.irradiance) what += " irradiance " + request.irradiance_name;
  LoadedScene loaded =
      session.load(std::move(description), {.command = measurement_text(what, request.target, request.period)});
  const Scene& scene = loaded.scene();
  const Target target = request.target ? *request.target : default_target(scene, session.log());
  check_target(scene, target);
  HorizontalIrradiance irradiance(loaded);
  LitBands wavelengths(scene.wavelengths(), irradiance, request.irradiance);
  Incoming incoming(scene, std::move(irradiance), wavelengths.sample_for_index(0, 0.5f));
  const size_t materials = loaded.description().materials.size(), bands = scene.wavelengths().bands().size();
  state_ = std::make_unique<State>(
      State{std::move(loaded), target, std::move(incoming), std::move(wavelengths), materials, bands});
  state_->reflectors = reflectors_of(state_->scene());
  state_->moments.resize(state_->quantities() * bands);
  state_->seen.resize(bands);
  if (!request.by_instance) return;
  const uint64_t instances = state_->scene().geometry().instances();
  if (instances == 0) fail({}, "this scene has no instances of objects (ObjectInstance, Shape \"instances\")");
  if (const double bytes = double(instances) * double(bands) * InstanceSums::kCellBytes; bytes > machine_memory())
    fail({}, "{} instances and {} bands need {:.1f} GB of memory, this machine has {:.1f} GB: use fewer bands",
         instances, bands, bytes * 1e-9, machine_memory() * 1e-9);
  state_->by_instance = std::make_unique<InstanceSums>(instances, bands);
}

FluxMeter::~FluxMeter() = default;

const Scene& FluxMeter::scene() const { return state_->scene(); }

void FluxMeter::trace(uint64_t paths, ThreadPool& pool, const RenderControl& control,
                      const std::function<void()>& after_round) {
  // Blocks are traced in batches; their sums are added in order, so that the result does not depend on threads.
  constexpr uint64_t kBlocks = 256;
  RenderStatistics statistics;
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const StopScope stop(control.stop);
  const DeadlineScope deadline(control.deadline);
  for (uint64_t done = 0; done < paths && !control.is_over();) {
    const uint64_t round = std::min(paths - done, kBlocks * Sums::kBlock);
    const uint64_t blocks = (round + Sums::kBlock - 1) / Sums::kBlock;
    std::vector<std::unique_ptr<Sums>> sums(blocks);
    size_t complete = 0;  // number of the first blocks that are complete
    std::mutex in_order;
    const auto trace_block = [&](int64_t block, int) {
      const uint64_t begin = uint64_t(block) * Sums::kBlock;
      auto one = std::make_unique<Sums>(*state_);
      one->trace(state_->paths + begin, std::min(Sums::kBlock, round - begin));
      const std::lock_guard lock(in_order);
      sums[size_t(block)] = std::move(one);
      for (; complete < blocks && sums[complete]; ++complete) sums[complete]->add_instances();
    };
    try {
      pool.for_each(int64_t(blocks), trace_block);
    } catch (const Stopped&) {  // those before the first incomplete block count
      if (!control.is_over()) throw;
      sums.resize(complete);
    }
    const uint64_t traced = std::min(round, sums.size() * Sums::kBlock);
    for (const auto& one : sums) {
      for (size_t i = 0; i < state_->moments.size(); ++i) state_->moments[i] += one->moments[i];
      for (size_t i = 0; i < state_->seen.size(); ++i) state_->seen[i] += one->seen[i];
    }
    state_->paths += traced;
    done += traced;
    statistics.paths = done;
    statistics.cpu_seconds = cpu_seconds() - cpu;
    statistics.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (control.progress) control.progress->update(double(done) / double(paths), statistics);
    if (after_round) after_round();
  }
  if (control.progress) control.progress->finish();
}

uint64_t FluxMeter::paths() const { return state_->paths; }

void FluxMeter::save(const std::filesystem::path& path) const {
  const auto sums = state_->sums();
  write_sums(path, state_->loaded.identity(), {sums.begin(), sums.end()});
}

void FluxMeter::resume(const std::filesystem::path& path) {
  read_sums(path, state_->loaded.identity(), state_->sums());
}

FluxMeasurement FluxMeter::read() const {
  const State& s = *state_;
  const auto shares = [&](size_t quantity) {
    std::vector<MeanError> result;
    for (size_t band = 0; band < s.bands; ++band)
      result.push_back(s.moments[quantity * s.bands + band].share(s.seen[band]));
    return result;
  };
  FluxMeasurement measurement{.bands = {},
                              .reflected = shares(kReflected),
                              .transmitted = shares(kTransmitted),
                              .materials = {},
                              .sum = shares(kTotal),
                              .paths = s.paths,
                              .target_area = (s.target.x1 - s.target.x0) * (s.target.y1 - s.target.y0),
                              .by_instance = {},
                              .areas = {}};
  const auto bands = s.scene().wavelengths().bands();
  measurement.bands.assign(bands.begin(), bands.end());
  for (const uint32_t m : s.reflectors) {
    const MaterialDescription& material = s.loaded.description().materials[m];
    FluxMeasurement::OfMaterial one{
        material.name.empty() ? material.plugin.name : material.name, shares(PathRecord::of_material(m, kAbsorbed)),
        shares(PathRecord::of_material(m, kIncident)), shares(PathRecord::of_material(m, kUncollided))};
    one.is_met = std::ranges::any_of(one.incident, [](const MeanError& share) { return share.mean > 0; });
    if (!one.is_met)
      for (auto* of_material : {&one.absorbed, &one.incident, &one.uncollided})
        for (MeanError& share : *of_material) share.standard_error = NAN;
    measurement.materials.push_back(std::move(one));
  }
  if (!s.by_instance) return measurement;
  measurement.areas = s.scene().geometry().areas();
  measurement.by_instance.reserve(s.by_instance->size());
  for (size_t cell = 0; cell < s.by_instance->size(); ++cell) {
    const Moment moment = s.by_instance->at(cell);
    measurement.by_instance.push_back(moment.share(s.seen[cell % s.bands]));
    if (moment.sum == 0) measurement.by_instance.back().standard_error = NAN;
  }
  return measurement;
}

double FluxMeasurement::error() const {
  double squares = 0;
  size_t count = 0;
  const auto add = [&](const std::vector<MeanError>& shares) {
    for (const MeanError& s : shares) squares += s.standard_error * s.standard_error, ++count;
  };
  add(reflected);
  for (const OfMaterial& m : materials)
    if (m.is_met) add(m.absorbed);
  return count == 0 ? 0 : std::sqrt(squares / double(count));
}

}  // namespace frond
