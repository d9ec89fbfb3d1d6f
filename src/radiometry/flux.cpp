#include "radiometry/flux.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "integrators/path_state.h"
#include "radiometry/flux_sums.h"
#include "radiometry/incident_light.h"
#include "radiometry/lit_bands.h"
#include "radiometry/path_pairs.h"
#include "radiometry/photons.h"
#include "radiometry/radiometer_scene.h"
#include "radiometry/ratio_sums.h"
#include "radiometry/trace_blocks.h"
#include "scene/leaf_models.h"
#include "system/machine.h"

namespace frond {
namespace {

std::string name_of(const MaterialDescription& material) {
  return material.name.empty() ? material.plugin.name : material.name;
}

/// Returns the flags of the materials that count as leaves; empty if there are none.
std::vector<uint8_t> leaves_of(const SceneDescription& description, const FluxRequest& request,
                               const Registry& registry) {
  if (!request.energy) return {};
  std::vector<uint8_t> flags = request.leaves.empty() ? leaf_flags(description, registry)
                                                      : counted_materials(description, request.leaves, registry);
  if (std::ranges::count(flags, 0) == std::ssize(flags)) flags.clear();
  return flags;
}

/// Returns the range of all ranges; nullopt if there are none.
std::optional<Interval> range_of(const std::vector<Interval>& ranges) {
  if (ranges.empty()) return {};
  return Interval{std::ranges::min(ranges, {}, &Interval::min).min, std::ranges::max(ranges, {}, &Interval::max).max};
}

/// Returns a text that identifies the request, except target and period.
std::string text_of(const FluxRequest& request) {
  std::string text = "flux";
  if (request.organs) text += fmt::format(" by {}", kOrganKinds[size_t(*request.organs)]);
  if (request.sides) text += " sides";
  if (request.energy) text += fmt::format(" energy, leaves {}", fmt::join(request.leaves, " "));
  for (const Interval& nm : request.ranges_nm) text += fmt::format(" {:g}:{:g}", nm.min, nm.max);
  if (request.irradiance) text += " irradiance " + request.irradiance_name;
  return text;
}

/// Returns a mean of an organ; its error is NaN if no path was absorbed.
MeanError organ_mean(const Moment& moment, uint64_t paths) {
  MeanError mean = moment.mean_of_pairs(paths);
  if (moment.sum == 0) mean.standard_error = NAN;
  return mean;
}

}  // namespace

struct FluxMeter::State {
  LoadedScene loaded;
  EntryBox entry;
  IncidentLight light;
  LitBands wavelengths;
  size_t materials, bands;
  FluxChannels channels;
  std::vector<uint8_t> is_leaf;           ///< by material index; empty: leaves are not measured apart
  std::vector<uint32_t> reflectors = {};  ///< indices of the materials of surfaces that light can hit
  std::vector<ExactMoment> moments = {};  ///< by quantity and channel
  std::vector<uint64_t> seen = {};        ///< number of paths, by band
  std::unique_ptr<Organs> organs = {};
  std::unique_ptr<OrganSums> by_organ = {};
  std::optional<Vec3> sun = {};          ///< direction toward the only sun
  std::vector<Interval> ranges_nm = {};  ///< of the bands, with splitting
  Interval optics_nm = {};               ///< of the scene's responses
  LeafArea leaf_area = {};
  uint64_t begin = 0, end = 0;  ///< numbers of the paths that have been traced
  /// Number of pairs of paths after which their bands repeat. Each turn has strata of its own, so that they are
  /// complete for each band.
  uint64_t turns = 1;

  size_t quantities() const {
    const size_t of_materials = kFirstOfMaterials + materials * kQuantitiesOfMaterial;
    return is_leaf.empty() ? of_materials : leaf_quantity(materials, kLeafGroups, kAbsorbed);
  }
  /// Moves wavelengths beyond the scene's responses to their ends.
  void limit_to_optics(SampledWavelengths& lambda) const {
    for (size_t lane = 0; lane < size_t(lambda.count); ++lane)
      lambda.nm[lane] = std::clamp(lambda.nm[lane], float(optics_nm.min), float(optics_nm.max));
  }
  size_t organ_channels() const { return channels.splits ? kOrganChannels * bands : bands; }
  const Scene& scene() const { return loaded.scene(); }
  /// Returns all accumulators as bytes.
  std::vector<std::span<const std::byte>> sums() const {
    std::vector<std::span<const std::byte>> arrays{std::as_bytes(std::span(moments)), std::as_bytes(std::span(seen))};
    if (by_organ) arrays.push_back(std::as_const(*by_organ).bytes());
    return arrays;
  }
};

/// Accumulators of one block of paths.
class FluxMeter::Block {
 public:
  static constexpr uint64_t kPaths = kBlockPaths;

  explicit Block(State& state)
      : moments(state.quantities() * state.channels.count()),
        seen(state.bands),
        state_(state),
        paths_{Path(state.quantities()), Path(state.quantities())} {}

  /// Traces pairs of paths. Both numbers are even. Throws SurfaceError.
  void trace(uint64_t first, uint64_t count) {
    constexpr uint64_t kPolled = 16;  // paths
    const uint64_t seed = state_.scene().seed();
    for (uint64_t i = first; i < first + count; i += 2) {
      if (i % kPolled == 0) check_stop();
      const uint64_t pair = i / 2, turn = pair % state_.turns;
      const Stratum stratum = stratum_of(pair / state_.turns, hash_key(seed, uint64_t{kStrata}, turn));
      for (uint64_t member = 0; member < 2; ++member) {
        RandomStream random(hash_key(seed, uint64_t{kStream}, i + member));
        Path& path = paths_[member];
        path.lambda = state_.wavelengths.sample_for_index(pair, random.uniform());
        path.shares.clear();
        trace_path(path, stratum.sample(random), hash_key(seed, uint64_t{kKeys}, i + member), random);
      }
      add_pair();
    }
  }
  /// Adds to the sums of organs, which have no block of their own: once the block counts.
  void add_organs() {
    for (const OfOrgan& o : of_organs_) state_.by_organ->add(o.organ, o.channel, o.share);
    of_organs_ = {};
  }

  std::vector<Moment> moments;
  std::vector<uint64_t> seen;

 private:
  /// Uses of the scene's seed.
  enum SeedUse : uint64_t { kStream = 0x666c7578, kKeys, kStrata };

  /// Light of one path, as shares of the incident light.
  struct Path {
    explicit Path(size_t quantities) : shares(quantities) {}
    FluxShares shares;
    SampledWavelengths lambda = {};
    bool is_direct = false;  ///< where the light came from
  };

  /// Traces light until it is absorbed or leaves the scene. `place`: uniform, for the place where it begins.
  void trace_path(Path& path, const UnitPoint& place, uint64_t key, RandomStream& random) {
    SampledWavelengths lambda = path.lambda;
    FluxShares& shares = path.shares;
    const auto light = state_.light.sample(place, random, lambda);
    if (!light) return;
    path.is_direct = light->is_direct;
    if (state_.channels.splits) state_.limit_to_optics(lambda);
    const Vec3d d = to_double(light->direction);
    const auto [entry, weight] = state_.entry.sample(d, light->place);
    const Scene& scene = state_.scene();
    const Target at_entry{.x0 = 0, .x1 = 0, .y0 = 0, .y1 = 0, .z = entry.z};
    Ray ray{
        light->origin ? *light->origin : to_float(entry - d * distance_above(scene, at_entry, -d.z) - scene.origin()),
        light->direction};
    SampledSpectrum share = light->weight;
    if (state_.entry.bottom && !light->origin) share *= SampledSpectrum(weight);
    constexpr int kFirstRoulette = 3, kPolled = 256;
    constexpr float kFull = 0.25f;  // share of the incident light below which Russian roulette may end a path
    const float full = kFull * share.max();
    for (int vertex = 0, depth = 0; vertex - depth <= kMostPassed; ++vertex) {
      if (vertex % kPolled == kPolled - 1) check_stop();
      SurfacePoint point;
      GeometryHit met;
      const VertexKey at = vertex_key(key, uint64_t(vertex));
      if (!scene.intersect(ray, at.key(Use::ray), point, met))
        return shares.add_end(ray.d.z > 0 ? kReflected : kTransmitted, share);
      arena_.reset();
      Scattered scattered;
      if (!scatter_light(point, lambda, ray.d, random, arena_, scattered)) {
        set_leaving_ray(point.hit, ray.d, ray);
        continue;
      }
      const uint64_t organ = state_.organs ? state_.organs->number(met) : 0;
      shares.add(flux_quantity(point.material_id, kIncident), share);
      if (depth++ == 0) shares.add(flux_quantity(point.material_id, kUncollided), share);
      const SampledSpectrum absorbed = share * SampledSpectrum(1 - scattered.weight.v);
      shares.add_absorbed(point.material_id, organ, share, absorbed);
      if (!state_.is_leaf.empty() && state_.is_leaf[point.material_id])
        add_leaf(point.hit, at, share, absorbed, shares);
      share *= scattered.weight;
      lambda.retire_black_lanes(share);
      if (share.is_black()) return;
      if (depth >= kFirstRoulette && !survives_roulette(share.max(), full, random, share)) return;
      set_leaving_ray(point.hit, scattered.direction, ray);
    }
  }

  /// Adds the light of a hit of a leaf, which is sunlit or shaded.
  void add_leaf(const Hit& hit, VertexKey at, const SampledSpectrum& incident, const SampledSpectrum& absorbed,
                FluxShares& shares) {
    const auto add = [&](FluxLeaves leaves) {
      shares.add(leaf_quantity(state_.materials, leaves, kAbsorbed), absorbed);
      shares.add(leaf_quantity(state_.materials, leaves, kIncident), incident);
    };
    add(kAllLeaves);
    if (state_.sun)
      add(is_sunlit(state_.scene(), hit, *state_.sun, at.key(Use::shadow_ray)) ? kSunlitLeaves : kShadedLeaves);
  }

  /// Adds the light of both paths of a pair to all sums.
  void add_pair() {
    const auto& [a, b] = paths_;
    for (size_t lane = 0; lane < size_t(a.lambda.count); ++lane) {
      const size_t band = a.lambda.band[lane];
      seen[band] += 2;
      const auto lane_of = [lane](const SampledSpectrum& first, const SampledSpectrum& second) {
        return PairShare{double(first.v[lane]), double(second.v[lane])};
      };
      // Photons relative to energy.
      PairShare photons{1, 1};
      if (state_.channels.splits) {
        const double mean_nm = state_.wavelengths.light(band).mean_nm;
        photons = PairShare{double(a.lambda.nm[lane]), double(b.lambda.nm[lane])} * (1 / mean_nm);
      }
      for (size_t q = 0; q < a.shares.values().size(); ++q) {
        const PairShare share = lane_of(a.shares.values()[q], b.shares.values()[q]);
        if (!share.is_zero()) add_share(q, band, share, photons);
      }
      visit_organs(a.shares, b.shares,
                   [&](uint64_t organ, const FluxShares::Light& of_a, const FluxShares::Light& of_b) {
                     add_organ(organ, band, lane_of(of_a.absorbed, of_b.absorbed),
                               lane_of(of_a.incident, of_b.incident), photons);
                   });
    }
  }

  /// Adds shares of a quantity; `photons`: factors from energy to photons.
  void add_share(size_t quantity, size_t band, const PairShare& share, const PairShare& photons) {
    const auto add = [&](size_t channel, const PairShare& x) {
      moments[quantity * state_.channels.count() + channel] += x.moment();
    };
    add(state_.channels.energy(band, kAllLight), share);
    if (!state_.channels.splits) return;
    add(state_.channels.photons(band, kAllLight), share * photons);
    for (const LightPart part : {kDirectLight, kDiffuseLight}) {
      const PairShare of_part = share * is_of(part);
      if (of_part.is_zero()) continue;
      add(state_.channels.energy(band, part), of_part);
      add(state_.channels.photons(band, part), of_part * photons);
    }
  }

  void add_organ(uint64_t organ, size_t band, const PairShare& absorbed, const PairShare& incident,
                 const PairShare& photons) {
    const auto add = [&](size_t channel, const PairShare& x) { of_organs_.push_back({organ, channel, x.moment()}); };
    if (!state_.channels.splits) return add(band, absorbed);
    const size_t first = band * kOrganChannels;
    add(first + kOrganEnergy, absorbed);
    add(first + kOrganDirect, absorbed * is_of(kDirectLight));
    add(first + kOrganPhotons, absorbed * photons);
    add(first + kOrganIncident, incident * kIncidentScale);
    add(first + kOrganIncidentPhotons, incident * photons * kIncidentScale);
  }

  /// Whether the light of each path is of a part: 1 or 0.
  PairShare is_of(LightPart part) const {
    const auto is = [part](const Path& path) { return path.is_direct == (part == kDirectLight) ? 1.0 : 0.0; };
    return {is(paths_[0]), is(paths_[1])};
  }

  struct OfOrgan {
    uint64_t organ;
    size_t channel;
    Moment share;
  };

  State& state_;
  Arena arena_;
  std::array<Path, 2> paths_;  ///< of a pair
  std::vector<OfOrgan> of_organs_;
};

FluxMeter::FluxMeter(Session& session, SceneDescription description, const FluxRequest& request, const Scene* other) {
  if (description.has_media())
    fail(description.media.front().plugin.where,
         "flux does not trace participating media; brf and render do, by integrator \"volpath\"");
  prepare_for_radiometry(session.registry(), request.wavelengths, request.period, false, description);
  // Light paths do not use the integrator: pilots of its light samples would be wasted.
  ParsedPlugin& integrator = description.integrator;
  if (find_param(session.registry().integrators.get(integrator.name, integrator.where), "lightsamples"))
    set_param(integrator.params, parsed_numbers("integer", "lightsamples", {1}));
  std::vector<uint8_t> is_leaf = leaves_of(description, request, session.registry());
  LoadedScene loaded = session.load(
      std::move(description), {.command = measurement_text(text_of(request), request.target, request.period)}, other);
  refuse_subsurface(loaded);
  const Scene& scene = loaded.scene();
  if (request.energy && scene.wavelengths().bands()[0].response.empty())
    fail({}, "energy is measured in bands with responses: single wavelengths have none");
  const bool lamps = has_lamps(scene.lights());
  const bool outside = std::ranges::any_of(scene.lights(), &Light::is_distant);
  if (lamps && request.irradiance && (request.energy || outside))
    fail({}, "an irradiance replaces the spectrum of light from outside: lamps in the scene have their own");
  // No light of lamps passes a target.
  const Target target = request.target      ? *request.target
                        : lamps && !outside ? Target{0, 1, 0, 1, 0}
                                            : default_target(scene, session.log());
  if (outside) check_target(scene, target);
  std::vector<Interval> ranges_nm = request.ranges_nm;
  if (request.energy && ranges_nm.empty())
    for (const Band& band : scene.wavelengths().bands())
      ranges_nm.push_back({band.response.front().nm, band.response.back().nm});
  const EntryBox entry{target, request.sides ? std::optional(bottom_of(scene)) : std::nullopt};
  HorizontalIrradiance irradiance(loaded, range_of(ranges_nm), entry.target_area());
  LitBands wavelengths(scene.wavelengths(), irradiance, request.irradiance, request.ranges_nm);
  IncidentLight light(scene, std::move(irradiance), wavelengths.sample_for_index(0, 0.5f));
  const size_t materials = loaded.description().materials.size(), bands = scene.wavelengths().bands().size();
  if (request.sides && scene.period()) fail({}, "a periodic scene has no sides through which light could enter");
  state_ = std::make_unique<State>(State{std::move(loaded), entry, std::move(light), std::move(wavelengths), materials,
                                         bands, FluxChannels{bands, request.energy}, std::move(is_leaf)});
  State& s = *state_;
  s.reflectors = reflectors_of(s.scene());
  s.moments.resize(s.quantities() * s.channels.count());
  s.seen.resize(bands);
  s.turns = s.wavelengths.turns();
  s.optics_nm = s.scene().wavelengths().range_nm();
  s.ranges_nm = std::move(ranges_nm);
  if (!s.is_leaf.empty()) {
    constexpr size_t kPoints = 1 << 17;
    s.sun = direction_to_sun(s.scene().lights());
    s.leaf_area =
        leaf_area(s.scene(), lamps ? std::nullopt : std::optional(target), s.is_leaf, s.sun, kPoints, session.pool());
  }
  if (!request.organs) return;
  std::vector<std::string> names;
  for (const MaterialDescription& m : s.loaded.description().materials) names.push_back(name_of(m));
  s.organs = std::make_unique<Organs>(s.scene(), std::move(names), *request.organs);
  const double bytes = double(s.organs->size()) * double(s.organ_channels()) * OrganSums::kCellBytes;
  if (bytes > machine_memory())
    fail({}, "{} organs and {} bands need {:.1f} GB of memory, this machine has {:.1f} GB: use fewer bands",
         s.organs->size(), bands, bytes * 1e-9, machine_memory() * 1e-9);
  s.by_organ = std::make_unique<OrganSums>(s.organs->size(), s.organ_channels());
}

FluxMeter::~FluxMeter() = default;

const Scene& FluxMeter::scene() const { return state_->scene(); }
const Organs* FluxMeter::organs() const { return state_->organs.get(); }

void FluxMeter::trace(uint64_t paths, ThreadPool& pool, const RenderControl& control,
                      const std::function<void()>& after_round) {
  State& s = *state_;
  trace_blocks<Block>(
      s.loaded, s.end, paths + paths % 2, pool, control, [&s] { return std::make_unique<Block>(s); },
      [&s](const Block& block) {
        for (size_t i = 0; i < s.moments.size(); ++i) s.moments[i].add(block.moments[i]);
        for (size_t i = 0; i < s.seen.size(); ++i) s.seen[i] += block.seen[i];
      },
      after_round);
}

std::vector<MeanError> FluxMeter::sunlit_organs(ThreadPool& pool) const {
  constexpr size_t kLeast = 4, kMost = 1 << 14;
  const State& s = *state_;
  const std::optional<Vec3> sun = direction_to_sun(s.scene().lights());
  if (!sun) return std::vector<MeanError>(s.organs->size(), kUnknown);
  return sunlit_shares(s.scene(), *s.organs, *sun, std::clamp(size_t(paths()) / s.organs->size(), kLeast, kMost), pool);
}

double FluxMeter::target_area() const { return state_->entry.target_area(); }

uint64_t FluxMeter::paths() const { return state_->end - state_->begin; }
uint64_t FluxMeter::end() const { return state_->end; }

void FluxMeter::start_at(uint64_t path) { state_->begin = state_->end = path; }

SumsPart FluxMeter::part() const {
  SumsPart part{state_->loaded.identity(), state_->begin, state_->end, {}};
  for (const auto& array : state_->sums())
    part.arrays.emplace_back(reinterpret_cast<const char*>(array.data()), array.size());
  return part;
}

void FluxMeter::add(const SumsPart& part, const std::string& name) {
  State& s = *state_;
  const std::string difference = s.loaded.identity().difference(part.identity, "this command", '"' + name + '"');
  if (!difference.empty()) fail({}, "\"{}\" is a part of another measurement. {}", name, difference);
  const auto sums = s.sums();
  if (!std::ranges::equal(sums, part.arrays, {}, std::ranges::size, std::ranges::size))
    fail({}, "\"{}\" is damaged: measure it again", name);
  if (s.begin == s.end) start_at(part.begin);
  s.end = part.end;
  add_elements(std::span(s.moments), std::as_bytes(std::span(part.arrays[0])));
  add_elements(std::span(s.seen), std::as_bytes(std::span(part.arrays[1])));
  if (s.by_organ) s.by_organ->add(std::as_bytes(std::span(part.arrays[2])));
}

FluxMeasurement FluxMeter::read() const {
  const State& s = *state_;
  const auto bands = s.scene().wavelengths().bands();
  const auto shares = [&](size_t quantity) {
    std::vector<MeanError> result;
    for (size_t band = 0; band < s.bands; ++band) {
      const ExactMoment& all = s.moments[quantity * s.channels.count() + s.channels.energy(band, kAllLight)];
      result.push_back(all.value().mean_of_pairs(s.seen[band]));
    }
    return result;
  };
  FluxMeasurement measurement{.bands = {bands.begin(), bands.end()},
                              .reflected = shares(kReflected),
                              .transmitted = shares(kTransmitted),
                              .materials = {},
                              .sum = shares(kTotal),
                              .paths = paths(),
                              .target_area = has_lamps(s.scene().lights()) ? 1 : target_area(),
                              .by_organ = {},
                              .areas = {}};
  measurement.has_lamps = has_lamps(s.scene().lights());
  const std::vector<double> areas = areas_of_materials(s.scene().geometry(), s.materials);
  for (const uint32_t m : s.reflectors) {
    FluxMeasurement::OfMaterial one{name_of(s.loaded.description().materials[m]), shares(flux_quantity(m, kAbsorbed)),
                                    shares(flux_quantity(m, kIncident)), shares(flux_quantity(m, kUncollided))};
    one.is_hit = std::ranges::any_of(one.incident, [](const MeanError& share) { return share.mean > 0; });
    if (!one.is_hit)
      for (auto* of_material : {&one.absorbed, &one.incident, &one.uncollided})
        for (MeanError& share : *of_material) share.standard_error = NAN;
    one.area = areas[m];
    measurement.materials.push_back(std::move(one));
  }
  if (s.channels.splits) measurement.energy = read_energy();
  if (!s.by_organ) return measurement;
  measurement.areas = s.organs->areas();
  if (s.channels.splits) {
    for (const OrganShare& share : measurement.energy->organs) measurement.by_organ.push_back(share.energy);
    return measurement;
  }
  measurement.by_organ.reserve(s.by_organ->size());
  for (size_t cell = 0; cell < s.by_organ->size(); ++cell)
    measurement.by_organ.push_back(organ_mean(s.by_organ->at(cell), s.seen[cell % s.bands]));
  return measurement;
}

EnergyBudget FluxMeter::read_energy() const {
  const State& s = *state_;
  const auto shares = [&s](size_t quantity) {
    std::vector<EnergyShare> result;
    for (size_t band = 0; band < s.bands; ++band) {
      const auto parts = [&](size_t first) {
        const auto mean = [&](LightPart part) {
          return s.moments[quantity * s.channels.count() + first + part].value().mean_of_pairs(s.seen[band]);
        };
        return LightParts{mean(kAllLight), mean(kDirectLight), mean(kDiffuseLight)};
      };
      result.push_back({parts(s.channels.energy(band, kAllLight)), parts(s.channels.photons(band, kAllLight))});
    }
    return result;
  };
  EnergyBudget budget;
  budget.reflected = shares(kReflected), budget.transmitted = shares(kTransmitted);
  for (size_t band = 0; band < s.bands; ++band) {
    const BandLight all = s.wavelengths.light(band), direct = s.wavelengths.direct_light(band);
    budget.incident.push_back(
        {s.ranges_nm[band],
         {all.energy, direct.energy},
         {all.energy * all.mean_nm / kPhotonEnergy, direct.energy * direct.mean_nm / kPhotonEnergy}});
  }
  for (const uint32_t m : s.reflectors)
    budget.materials.push_back({name_of(s.loaded.description().materials[m]), shares(flux_quantity(m, kAbsorbed)),
                                shares(flux_quantity(m, kIncident))});
  if (!s.is_leaf.empty()) {
    const auto leaves = [&](FluxLeaves group) {
      return EnergyBudget::OfLeaves{shares(leaf_quantity(s.materials, group, kAbsorbed)),
                                    shares(leaf_quantity(s.materials, group, kIncident))};
    };
    budget.leaves = leaves(kAllLeaves);
    if (s.sun) budget.sunlit = leaves(kSunlitLeaves), budget.shaded = leaves(kShadedLeaves);
    budget.leaf_area = s.leaf_area;
  }
  if (!s.by_organ) return budget;
  for (size_t cell = 0; cell < s.by_organ->size(); cell += kOrganChannels) {
    const uint64_t paths = s.seen[cell / kOrganChannels % s.bands];
    const auto absorbed = [&](size_t channel) { return organ_mean(s.by_organ->at(cell + channel), paths); };
    const auto incident = [&](size_t channel) {
      const MeanError mean = organ_mean(s.by_organ->at(cell + channel), paths);
      return MeanError{mean.mean / kIncidentScale, mean.standard_error / kIncidentScale};
    };
    budget.organs.push_back({absorbed(kOrganEnergy), absorbed(kOrganDirect), absorbed(kOrganPhotons),
                             incident(kOrganIncident), incident(kOrganIncidentPhotons)});
  }
  return budget;
}

}  // namespace frond
