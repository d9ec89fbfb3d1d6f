#include "radiometry/fluorescence_flux.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/math/sampling.h"
#include "integrators/excitation.h"
#include "integrators/path_state.h"
#include "radiometry/flux_sums.h"
#include "radiometry/incident_light.h"
#include "radiometry/lit_bands.h"
#include "radiometry/path_pairs.h"
#include "radiometry/radiometer_scene.h"
#include "radiometry/ratio_sums.h"
#include "radiometry/trace_blocks.h"
#include "scene/fluorescence_by_material.h"
#include "scene/format/plugin_text.h"
#include "spectra/wavelengths/radiant.h"
#include "spectra/wavelengths/spectrum_points.h"
#include "system/machine.h"

namespace frond {
namespace {

/// Quantities of one path at each wavelength of emission. Absorption by each material follows.
enum Quantity : size_t { kEmitted, kReabsorbed, kLeft, kUpward, kDownward, kAbsorbedBy };

/// Quantities of an instance: the excitation, then these at each wavelength of emission.
enum OfInstance : size_t { kEmittedThere, kLeftThere, kQuantitiesOfInstance };

/// Factor on emission in the sums of instances: squares of a path's share, a density of 1e-6 to 1e-3 1/nm, would be as
/// small as the unit of the sums.
constexpr double kEmissionScale = 0x1p7;

/// The mean of a quantity from the sums of pairs. It is NaN where only the matrices of a leaf are known.
MeanError mean_of(const Moment& moment, uint64_t paths) {
  return std::isnan(moment.sum) ? kUnknown : moment.mean(paths);
}

/// Returns the photons of a spectrum (W m^-2 nm^-1) over the wavelengths of excitation, umol m^-2 s^-1.
double photons_of(const Spectrum& irradiance) {
  const std::vector<double> nm = points_nm(irradiance, kExcitation_nm);
  double sum = 0;
  for (size_t i = 1; i < nm.size(); ++i) {
    const double middle = (nm[i] + nm[i - 1]) / 2;
    sum += (nm[i] - nm[i - 1]) * double(irradiance.at(float(middle))) * middle / kPhotonEnergy;
  }
  return sum;
}

/// Density of wavelengths of excitation of the whole scene: photons of the light, times the mean over the materials of
/// the share that they absorb.
ExcitationSampler excitation_of(const std::vector<std::shared_ptr<const Fluorescence>>& by_material,
                                const Spectrum& irradiance) {
  return ExcitationSampler([&](double nm) {
    double absorbed = 0;
    for (const auto& fluorescence : by_material)
      if (fluorescence) absorbed += fluorescence->excitation(nm);
    return absorbed * double(irradiance.at(float(nm))) * nm;
  });
}

}  // namespace

struct FluorescenceFluxMeter::State {
  LoadedScene loaded;
  Target target;
  std::vector<std::shared_ptr<const Fluorescence>> by_material;
  SpectrumPtr irradiance;  ///< of the target, over the wavelengths of excitation
  double incident;         ///< photons_of(irradiance)
  IncidentLight light;
  ExcitationSampler excitation;
  size_t materials, emissions;
  uint64_t turns;  ///< turns_of(wavelengths of emission); each has strata of its own
  Moment excited = {};
  std::vector<Moment> moments = {};    ///< by quantity and wavelength of emission
  std::vector<RatioSums> escape = {};  ///< by wavelength of emission
  std::vector<uint64_t> seen = {};     ///< number of paths, by wavelength of emission
  std::unique_ptr<OrganSums> by_instance = {};
  uint64_t paths = 0;

  size_t quantities() const { return kAbsorbedBy + materials; }
  const Scene& scene() const { return loaded.scene(); }
};

/// Accumulators of one block of paths.
class FluorescenceFluxMeter::Block {
 public:
  static constexpr uint64_t kPaths = 1024;

  explicit Block(State& state)
      : moments(state.quantities() * state.emissions),
        escape(state.emissions),
        seen(state.emissions),
        state_(state),
        members_{Path(state.quantities()), Path(state.quantities())} {}

  /// Traces pairs of paths, both of which begin in one stratum. Both numbers are even. Throws SurfaceError.
  void trace(uint64_t first, uint64_t count) {
    constexpr uint64_t kPolled = 16;  // paths
    const uint64_t seed = state_.scene().seed();
    for (uint64_t i = first; i < first + count; i += 2) {
      if (i % kPolled == 0) check_stop();
      const uint64_t pair = i / 2, turn = pair % state_.turns;
      const Stratum stratum = stratum_of(pair / state_.turns, hash_key(seed, uint64_t{kStrata}, turn));
      emission_ = state_.scene().wavelengths().sample_for_index(pair, 0.5f);
      for (uint64_t member = 0; member < members_.size(); ++member) {
        RandomStream random(hash_key(seed, uint64_t{kStream}, i + member));
        path_ = &members_[member];
        path_->clear();
        trace_path(stratum.sample(random), hash_key(seed, uint64_t{kKeys}, i + member), random);
      }
      add_pair();
    }
  }
  /// Adds to the sums of instances, which have no block of their own: once the block counts.
  void add_organs() {
    for (const InstanceMoment& o : of_instances_) state_.by_instance->add(o.instance, o.quantity, o.moment);
    of_instances_ = {};
  }

  Moment excited;
  std::vector<Moment> moments;
  std::vector<RatioSums> escape;
  std::vector<uint64_t> seen;

 private:
  /// Uses of the scene's seed.
  enum SeedUse : uint64_t { kStream = 0x666c756f, kKeys, kStrata };

  /// Of a quantity of an instance.
  struct InstanceShare {
    uint64_t instance;
    size_t quantity;
    PairShare share;
  };
  struct InstanceMoment {
    uint64_t instance;
    size_t quantity;
    Moment moment;
  };

  /// What one path brings.
  struct Path {
    explicit Path(size_t quantities) : values(quantities) {}
    void clear() {
      std::ranges::fill(values, SampledSpectrum());
      excited = 0;
    }
    std::vector<SampledSpectrum> values;  ///< by quantity
    double excited = 0;
  };

  /// `place`: uniform, for the place where the light begins.
  void trace_path(const UnitPoint& place, uint64_t key, RandomStream& random) {
    const Target& t = state_.target;
    const SampledWavelengths lambda = state_.excitation.sample(random.uniform());
    const auto light = state_.light.sample(place, random, lambda);
    if (!light) return;
    // Photons that the lanes stand for, relative to all incident ones.
    SampledSpectrum photons;
    for (int e = 0; e < lambda.count; ++e) {
      const float nm = lambda.nm[size_t(e)], density = lambda.pdf[size_t(e)] * float(lambda.count);
      photons[e] =
          light->weight[e] * state_.irradiance->at(nm) * float(double(nm) / kPhotonEnergy / state_.incident) / density;
    }
    if (photons.is_black()) return;
    const Vec3d on_target{std::lerp(t.x0, t.x1, light->place[0]), std::lerp(t.y0, t.y1, light->place[1]), t.z};
    const Vec3d d = to_double(light->direction);
    const Scene& scene = state_.scene();
    const Ray ray{to_float(on_target - d * distance_above(scene, t, -d.z) - scene.origin()), light->direction};
    follow(
        ray, lambda, photons, key, random, arena_,
        [&](const SurfacePoint& point, const Vec3& toward_light, const SampledSpectrum& before, const SampledSpectrum&,
            uint64_t vertex_key) { excite(point, toward_light, lambda, before, vertex_key, random); },
        [](bool, const SampledSpectrum&) {});
  }

  /// Adds what light excites at a surface, and follows the emitted light.
  void excite(const SurfacePoint& point, const Vec3& toward_light, const SampledWavelengths& lambda,
              const SampledSpectrum& photons, uint64_t key, RandomStream& random) {
    const Fluorescence* fluorescence = state_.by_material[point.material_id].get();
    if (!fluorescence) return;
    const Vec3 wi = point.hit.shading.to_local(toward_light);
    SampledSpectrum emitted, reabsorbed, lit, opposite;
    double absorbed = 0;
    for (int e = 0; e < lambda.count; ++e) {
      if (photons[e] == 0) continue;
      double absorbed_here = 0;
      for (int f = 0; f < emission_.count; ++f) {
        const FluorescencePhotons p =
            fluorescence->photons(wi, double(emission_.nm[size_t(f)]), double(lambda.nm[size_t(e)]), random);
        absorbed_here += p.absorbed / emission_.count;
        emitted[f] += photons[e] * float(p.emitted);
        reabsorbed[f] += photons[e] * float(p.reabsorbed);
        lit[f] += photons[e] * float(p.lit_side);
        opposite[f] += photons[e] * float(p.opposite_side);
      }
      absorbed += double(photons[e]) * absorbed_here;
    }
    const SampledSpectrum left = lit + opposite;
    path_->excited += absorbed;
    path_->values[kEmitted] += emitted;
    path_->values[kReabsorbed] += reabsorbed;
    path_->values[kLeft] += left;
    if (state_.by_instance && point.instance_id > 0) add_instance(point.instance_id, absorbed, emitted, left);
    const float same = sum(lit), both = sum(left);
    if (!(both > 0)) return;
    emit(point, *fluorescence, wi, lambda, photons, std::clamp(same / both, 0.05f, 0.95f), key, random);
  }

  /// Follows light that leaves a surface. `same_side`: probability of the lit side.
  void emit(const SurfacePoint& point, const Fluorescence& fluorescence, const Vec3& wi,
            const SampledWavelengths& lambda, const SampledSpectrum& photons, float same_side, uint64_t key,
            RandomStream& random) {
    const bool is_same = random.uniform() < same_side;
    Vec3 wo = sample_cosine_hemisphere({random.uniform(), random.uniform()});
    if (is_same != (wi.z > 0)) wo.z = -wo.z;
    if (wo.z == 0) return;
    const double per_density = double(kPi) / double(is_same ? same_side : 1 - same_side);
    SampledSpectrum emitted;
    for (int f = 0; f < emission_.count; ++f)
      for (int e = 0; e < lambda.count; ++e) {
        if (photons[e] == 0) continue;
        const double value =
            fluorescence.f(wo, wi, double(emission_.nm[size_t(f)]), double(lambda.nm[size_t(e)]), random);
        emitted[f] += photons[e] * float(value * per_density);
      }
    Ray ray;
    set_leaving_ray(point.hit, point.hit.shading.to_world(wo), ray);
    SampledWavelengths active = emission_;
    active.retire_black_lanes(emitted);
    follow(
        ray, active, emitted, hash_key(key, uint64_t{kKeys}), random, emission_arena_,
        [&](const SurfacePoint& at, const Vec3&, const SampledSpectrum& before, const SampledSpectrum& after,
            uint64_t) { path_->values[kAbsorbedBy + at.material_id] += SampledSpectrum(before.v - after.v); },
        [&](bool is_upward, const SampledSpectrum& share) { path_->values[is_upward ? kUpward : kDownward] += share; });
  }

  /// Follows light until it is absorbed or leaves the scene. Calls at_hit(point, toward, before, after, key) at each
  /// surface: the direction in which the light came from, and the light before and after the scattering; and
  /// at_end(is_upward, light) where it leaves.
  template <class Hit, class End>
  void follow(Ray ray, SampledWavelengths lambda, SampledSpectrum light, uint64_t key, RandomStream& random,
              Arena& arena, const Hit& at_hit, const End& at_end) {
    constexpr int kFirstRoulette = 3;
    constexpr float kFull = 0.25f;  // share of the first light below which Russian roulette may end a path
    const float full = kFull * light.max();
    SurfacePoint point;
    for (int vertex = 0, depth = 0; vertex - depth <= kMostPassed && !light.is_black(); ++vertex) {
      poll_();
      const VertexKey at = vertex_key(key, uint64_t(vertex));
      if (!state_.scene().intersect(ray, at.key(Use::ray), point)) return at_end(ray.d.z > 0, light);
      arena.reset();
      Scattered scattered;
      if (!scatter_light(point, lambda, ray.d, random, arena, scattered)) {
        set_leaving_ray(point.hit, ray.d, ray);
        continue;
      }
      const SampledSpectrum before = light;
      light *= scattered.weight;
      at_hit(point, -ray.d, before, light, at.value);
      lambda.retire_black_lanes(light);
      if (++depth >= kFirstRoulette && !survives_roulette(light.max(), full, random, light)) return;
      set_leaving_ray(point.hit, scattered.direction, ray);
    }
  }

  static float sum(const SampledSpectrum& s) { return s[0] + s[1] + s[2] + s[3]; }

  void add_instance(uint64_t instance, double excited_there, const SampledSpectrum& emitted,
                    const SampledSpectrum& left) {
    const size_t member = path_ == &members_[0] ? 0 : 1;
    const auto add = [&](size_t quantity, double share) {
      shares_.push_back({instance, quantity, member == 0 ? PairShare{share, 0} : PairShare{0, share}});
    };
    if (!std::isnan(excited_there)) add(0, excited_there);
    for (int f = 0; f < emission_.count; ++f) {
      const size_t first = 1 + emission_.band[size_t(f)] * kQuantitiesOfInstance;
      if (!std::isnan(emitted[f])) add(first + kEmittedThere, double(emitted[f]) * kEmissionScale);
      add(first + kLeftThere, double(left[f]) * kEmissionScale);
    }
  }

  /// Adds what both paths of a pair bring to all sums.
  void add_pair() {
    const auto& [a, b] = members_;
    excited += PairShare{a.excited, b.excited}.moment();
    for (int f = 0; f < emission_.count; ++f) {
      const size_t at = emission_.band[size_t(f)];
      const auto of_pair = [&](size_t q) { return PairShare{double(a.values[q][f]), double(b.values[q][f])}; };
      seen[at] += 2;
      for (size_t q = 0; q < state_.quantities(); ++q) moments[q * state_.emissions + at] += of_pair(q).moment();
      if (const double left = of_pair(kLeft).moment().sum; left > 0)
        escape[at].add(of_pair(kUpward).moment().sum / left, left);
    }
    add_instances();
  }

  /// Adds up the shares of the pair's hits by instance and quantity.
  void add_instances() {
    const auto key = [](const InstanceShare& s) { return std::pair(s.instance, s.quantity); };
    std::ranges::sort(shares_, {}, key);
    for (size_t i = 0; i < shares_.size();) {
      const InstanceShare& first = shares_[i];
      PairShare sum;
      for (; i < shares_.size() && key(shares_[i]) == key(first); ++i)
        sum.first += shares_[i].share.first, sum.second += shares_[i].share.second;
      of_instances_.push_back({first.instance, first.quantity, sum.moment()});
    }
    shares_.clear();
  }

  State& state_;
  Arena arena_, emission_arena_;
  StopPoll poll_;
  std::array<Path, 2> members_;        ///< of the current pair
  Path* path_ = nullptr;               ///< current member
  SampledWavelengths emission_;        ///< of the current pair
  std::vector<InstanceShare> shares_;  ///< of the current pair, by hit
  std::vector<InstanceMoment> of_instances_;
};

FluorescenceFluxMeter::FluorescenceFluxMeter(Session& session, SceneDescription description,
                                             const FluorescenceFluxRequest& request, const Scene* other) {
  if (description.has_media()) fail(description.media.front().plugin.where, "flux does not trace participating media");
  description.integrator = {"path", {}, {}};  // has no effect here, and others refuse fluorescence
  prepare_for_radiometry(session.registry(), fmt::format("bands,fluorescence={}", fmt::join(request.emission_nm, ",")),
                         request.period, false, description, true);
  LoadedScene loaded =
      session.load(std::move(description),
                   {.command = measurement_text("flux of fluorescence", request.target, request.period)}, other);
  const Scene& scene = loaded.scene();
  const Target target = request.target ? *request.target : default_target(scene, other ? silent_log() : session.log());
  check_target(scene, target);
  const size_t materials = loaded.description().materials.size();
  std::vector<const Material*> all;
  for (size_t i = 0; i < materials; ++i) all.push_back(scene.material(i));
  auto by_material =
      fluorescence_by_material(all, {scene.wavelengths(), session.pool(), session.log(), session.cache()});
  SpectrumPtr irradiance = horizontal_irradiance(scene, kExcitation_nm, session.pool());
  const double incident = photons_of(*irradiance);
  if (!(incident > 0)) fail({}, "the scene has no light from 400 to 750 nm, which excites fluorescence");
  ExcitationSampler excitation = excitation_of(by_material, *irradiance);
  IncidentLight light(scene, HorizontalIrradiance(loaded), excitation.sample(0.5f));
  const uint64_t turns = turns_of(scene.wavelengths());
  state_ = std::make_unique<State>(State{std::move(loaded), target, std::move(by_material), std::move(irradiance),
                                         incident, std::move(light), std::move(excitation), materials,
                                         request.emission_nm.size(), turns});
  state_->moments.resize(state_->quantities() * state_->emissions);
  state_->escape.resize(state_->emissions);
  state_->seen.resize(state_->emissions);
  if (!request.by_instance) return;
  const uint64_t instances = state_->scene().geometry().instances();
  const size_t cells = 1 + kQuantitiesOfInstance * state_->emissions;
  if (instances == 0) fail({}, "this scene has no instances of objects (ObjectInstance, Shape \"instances\")");
  if (const double bytes = double(instances) * double(cells) * OrganSums::kCellBytes; bytes > machine_memory())
    fail({}, "{} instances and {} wavelengths need {:.1f} GB of memory: use fewer wavelengths", instances,
         state_->emissions, bytes * 1e-9);
  state_->by_instance = std::make_unique<OrganSums>(instances, cells);
}

FluorescenceFluxMeter::~FluorescenceFluxMeter() = default;

const LoadedScene& FluorescenceFluxMeter::loaded() const { return state_->loaded; }

const Target& FluorescenceFluxMeter::target() const { return state_->target; }

uint64_t FluorescenceFluxMeter::paths() const { return state_->paths; }

void FluorescenceFluxMeter::trace(uint64_t paths, ThreadPool& pool, const RenderControl& control) {
  State& s = *state_;
  trace_blocks<Block>(
      s.loaded, s.paths, paths + paths % 2, pool, control, [&s] { return std::make_unique<Block>(s); },
      [&s](const Block& block) {
        s.excited += block.excited;
        for (size_t i = 0; i < s.moments.size(); ++i) s.moments[i] += block.moments[i];
        for (size_t i = 0; i < s.emissions; ++i) s.seen[i] += block.seen[i], s.escape[i] += block.escape[i];
      });
}

FluorescenceFluxMeasurement FluorescenceFluxMeter::read() const {
  const State& s = *state_;
  const auto means = [&](size_t quantity) {
    std::vector<MeanError> result;
    for (size_t i = 0; i < s.emissions; ++i)
      result.push_back(mean_of(s.moments[quantity * s.emissions + i], s.seen[i]));
    return result;
  };
  FluorescenceFluxMeasurement m{.emission_nm = {},
                                .shapes = {},
                                .incident = s.incident,
                                .excited = mean_of(s.excited, s.paths),
                                .emitted = means(kEmitted),
                                .reabsorbed = means(kReabsorbed),
                                .left = means(kLeft),
                                .upward = means(kUpward),
                                .downward = means(kDownward),
                                .escape = {},
                                .materials = {},
                                .paths = s.paths};
  for (const Band& band : s.scene().wavelengths().bands()) m.emission_nm.push_back(band.nm);
  for (const RatioSums& sums : s.escape) m.escape.push_back(sums.ratio());
  for (const auto& fluorescence : s.by_material)
    if (fluorescence && !std::ranges::count(m.shapes, fluorescence->emission_shape()))
      m.shapes.push_back(fluorescence->emission_shape());
  for (size_t i = 0; i < s.materials; ++i) {
    const MaterialDescription& material = s.loaded.description().materials[i];
    if (!s.scene().material(i)) continue;
    m.materials.push_back({material.shown_name(), means(kAbsorbedBy + i)});
  }
  if (!s.by_instance) return m;
  const size_t cells = 1 + kQuantitiesOfInstance * s.emissions;
  const bool is_known = !std::isnan(m.excited.mean);
  const auto emission_mean = [&s](size_t cell, size_t emission) {
    return scaled(s.by_instance->at(cell).mean(s.seen[emission]), 1 / kEmissionScale);
  };
  for (size_t first = 0; first < s.by_instance->size(); first += cells) {
    auto& one = m.instances.emplace_back();
    one.excited = is_known ? s.by_instance->at(first).mean(s.paths) : kUnknown;
    for (size_t i = 0; i < s.emissions; ++i) {
      const size_t at = first + 1 + i * kQuantitiesOfInstance;
      one.emitted.push_back(is_known ? emission_mean(at + kEmittedThere, i) : kUnknown);
      one.left.push_back(emission_mean(at + kLeftThere, i));
    }
  }
  return m;
}

double FluorescenceFluxMeasurement::relative_error() const {
  double squares = 0;
  for (const MeanError& v : upward) squares += v.mean > 0 ? std::pow(v.standard_error / v.mean, 2) : 0;
  return std::sqrt(squares / double(upward.size()));
}

}  // namespace frond
