#include <array>
#include <memory>

#include "core/arena.h"
#include "integrators/path_state.h"
#include "radiometry/flux_state.h"
#include "radiometry/path_pairs.h"
#include "radiometry/trace_blocks.h"

namespace frond {

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

}  // namespace frond
