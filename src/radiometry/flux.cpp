#include "radiometry/flux.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/stop.h"
#include "integrators/path_parts.h"
#include "integrators/path_state.h"
#include "radiometry/flux_sums.h"
#include "radiometry/incident_light.h"
#include "radiometry/lit_bands.h"
#include "radiometry/radiometer_scene.h"
#include "radiometry/sums_file.h"
#include "system/machine.h"

namespace frond {
namespace {

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

}  // namespace

struct FluxMeter::State {
  LoadedScene loaded;
  Target target;
  IncidentLight light;
  LitBands wavelengths;
  size_t materials, bands;
  std::vector<uint32_t> reflectors = {};  ///< indices of the materials of surfaces that light can hit
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
class FluxMeter::Block {
 public:
  static constexpr uint64_t kPaths = 1024;

  explicit Block(State& state)
      : moments(state.quantities() * state.bands), seen(state.bands), state_(state), shares_(state.quantities()) {}

  /// Throws SurfaceError.
  void trace(uint64_t first, uint64_t count) {
    constexpr uint64_t kPolled = 16;  // paths
    for (uint64_t i = first; i < first + count; ++i) {
      if (i % kPolled == 0) check_stop();
      RandomStream random(hash_key(state_.scene().seed(), uint64_t{kStream}, i));
      const SampledWavelengths lambda = state_.wavelengths.sample_for_index(i, random.uniform());
      shares_.clear();
      trace_path(lambda, hash_key(state_.scene().seed(), uint64_t{kKeys}, i), random);
      add_shares(lambda);
    }
  }
  /// Adds to the sums of instances, which have no block of their own: once the block counts.
  void add_instances() {
    for (const Absorbed& a : absorbed_) state_.by_instance->add(a.instance, a.band, a.share);
    absorbed_ = {};
  }

  std::vector<Moment> moments;
  std::vector<uint64_t> seen;

 private:
  /// Uses of the scene's seed.
  enum SeedUse : uint64_t { kStream = 0x666c7578, kKeys };

  /// Traces light until it is absorbed or leaves the scene.
  void trace_path(SampledWavelengths lambda, uint64_t key, RandomStream& random) {
    const Target& t = state_.target;
    const Vec2 u{random.uniform(), random.uniform()};
    const auto light = state_.light.sample(random, lambda);
    if (!light) return;
    const Vec3d on_target{std::lerp(t.x0, t.x1, double(u.x)), std::lerp(t.y0, t.y1, double(u.y)), t.z};
    const Vec3d d = to_double(light->direction);
    const Scene& scene = state_.scene();
    Ray ray{to_float(on_target - d * distance_above(scene, t, -d.z) - scene.origin()), light->direction};
    SampledSpectrum share = light->weight;
    constexpr int kFirstRoulette = 3, kPolled = 256;
    constexpr float kFull = 0.25f;  // share of the incident light below which Russian roulette may end a path
    const float full = kFull * share.max();
    for (int vertex = 0, depth = 0; vertex - depth <= kMostPassed; ++vertex) {
      if (vertex % kPolled == kPolled - 1) check_stop();
      SurfacePoint point;
      if (!scene.intersect(ray, vertex_key(key, uint64_t(vertex)).key(Use::ray), point))
        return shares_.add_end(ray.d.z > 0 ? kReflected : kTransmitted, share);
      arena_.reset();
      Scattered scattered;
      const bool scatters = name_material_in_errors(point, [&] {
        const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, arena_);
        if (!bsdf) return false;
        LocalBsdf local;
        local.set(*bsdf, point.hit, -ray.d);
        local.scatter_light(random, scattered);
        if (!is_valid_sample(scattered))
          throw SurfaceError(point.material_id, "it scatters weights that are negative, infinite or not a number");
        return true;
      });
      if (!scatters) {
        set_leaving_ray(point.hit, ray.d, ray);
        continue;
      }
      shares_.add(flux_quantity(point.material_id, kIncident), share);
      if (depth++ == 0) shares_.add(flux_quantity(point.material_id, kUncollided), share);
      shares_.add_absorbed(point.material_id, point.instance_id, share * SampledSpectrum(1 - scattered.weight.v));
      share *= scattered.weight;
      lambda.retire_black_lanes(share);
      if (share.is_black()) return;
      if (depth >= kFirstRoulette && !survives_roulette(share.max(), full, random, share)) return;
      set_leaving_ray(point.hit, scattered.direction, ray);
    }
  }

  void add_shares(const SampledWavelengths& lambda) {
    for (size_t q = 0; q < shares_.values().size(); ++q) {
      const SensorResponse response = state_.scene().wavelengths().sensor(shares_.values()[q], lambda);
      for (size_t k = 0; k < size_t(response.count); ++k)
        moments[q * state_.bands + response.channel[k]].add(response.value[k]);
    }
    for (size_t lane = 0; lane < size_t(lambda.count); ++lane) {
      ++seen[lambda.band[lane]];
      if (!state_.by_instance) continue;
      for (const auto& [instance, share] : shares_.absorbed_by_instance())
        absorbed_.push_back({instance, lambda.band[lane], double(share.v[lane])});
    }
  }

  struct Absorbed {
    uint64_t instance;
    size_t band;
    double share;
  };

  State& state_;
  Arena arena_;
  FluxShares shares_;
  std::vector<Absorbed> absorbed_;
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
  IncidentLight light(scene, std::move(irradiance), wavelengths.sample_for_index(0, 0.5f));
  const size_t materials = loaded.description().materials.size(), bands = scene.wavelengths().bands().size();
  state_ = std::make_unique<State>(
      State{std::move(loaded), target, std::move(light), std::move(wavelengths), materials, bands});
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
  const RenderTimer timer;
  const StopScope stop(control.stop);
  const DeadlineScope deadline(control.deadline);
  for (uint64_t done = 0; done < paths && !control.is_over();) {
    const uint64_t round = std::min(paths - done, kBlocks * Block::kPaths);
    const uint64_t blocks = (round + Block::kPaths - 1) / Block::kPaths;
    std::vector<std::unique_ptr<Block>> traced_blocks(blocks);
    size_t complete = 0;  // number of the first blocks that are complete
    std::mutex in_order;
    const auto trace_block = [&](int64_t block, int) {
      const uint64_t begin = uint64_t(block) * Block::kPaths;
      auto one = std::make_unique<Block>(*state_);
      one->trace(state_->paths + begin, std::min(Block::kPaths, round - begin));
      const std::lock_guard lock(in_order);
      traced_blocks[size_t(block)] = std::move(one);
      for (; complete < blocks && traced_blocks[complete]; ++complete) traced_blocks[complete]->add_instances();
    };
    try {
      pool.for_each(int64_t(blocks), trace_block);
    } catch (const SurfaceError& error) {
      const MaterialDescription& material = state_->loaded.description().materials[error.material_id];
      fail(material.plugin.where, "{} has a defect: {}", name_in_messages(material), error.what());
    } catch (const Stopped&) {  // those before the first incomplete block count
      if (!control.is_over()) throw;
      traced_blocks.resize(complete);
    }
    const uint64_t traced = std::min(round, traced_blocks.size() * Block::kPaths);
    for (const auto& one : traced_blocks) {
      for (size_t i = 0; i < state_->moments.size(); ++i) state_->moments[i] += one->moments[i];
      for (size_t i = 0; i < state_->seen.size(); ++i) state_->seen[i] += one->seen[i];
    }
    state_->paths += traced;
    done += traced;
    statistics.paths = done;
    timer.read(statistics);
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
      result.push_back(s.moments[quantity * s.bands + band].mean(s.seen[band]));
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
    FluxMeasurement::OfMaterial one{material.name.empty() ? material.plugin.name : material.name,
                                    shares(flux_quantity(m, kAbsorbed)), shares(flux_quantity(m, kIncident)),
                                    shares(flux_quantity(m, kUncollided))};
    one.is_hit = std::ranges::any_of(one.incident, [](const MeanError& share) { return share.mean > 0; });
    if (!one.is_hit)
      for (auto* of_material : {&one.absorbed, &one.incident, &one.uncollided})
        for (MeanError& share : *of_material) share.standard_error = NAN;
    measurement.materials.push_back(std::move(one));
  }
  if (!s.by_instance) return measurement;
  measurement.areas = s.scene().geometry().areas();
  measurement.by_instance.reserve(s.by_instance->size());
  for (size_t cell = 0; cell < s.by_instance->size(); ++cell) {
    const Moment moment = s.by_instance->at(cell);
    measurement.by_instance.push_back(moment.mean(s.seen[cell % s.bands]));
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
    if (m.is_hit) add(m.absorbed);
  return count == 0 ? 0 : std::sqrt(squares / double(count));
}

}  // namespace frond
