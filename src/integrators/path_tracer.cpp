#include "integrators/path_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/math/sampling.h"
#include "core/parallel.h"
#include "integrators/lane_set.h"
#include "integrators/path_parts.h"
#include "integrators/path_state.h"
#include "integrators/vertex_numbers.h"

namespace frond {
namespace {

/// Traces the paths of a bundle together, one vertex after the other.
class PathTracer final : public Tracer {
 public:
  PathTracer(const World& world, const LightSelector& selector, const PathSettings& settings, SplitRecord* record)
      : world_(world), selector_(selector), settings_(settings), record_(record) {}

  void trace(PathBundle& bundle) override {
    bundle_ = &bundle;
    at_ = nullptr;
    if (record_) *record_ = SplitRecord();
    with_surface_of_errors(at_, [this] { trace(); });
  }

 private:
  static constexpr size_t kMost = PathBundle::kMost, kWidth = RayPacket::kWidth;
  static constexpr uint32_t kPacket = (1u << kWidth) - 1;  ///< lanes of one packet

  /// Traces all paths with the first rays that their first vertices scatter, then with the second ones, and so on.
  void trace() {
    branch_ = 0;
    vertex_ = 0;
    follow(advance(meet_first(begin())));
    for (const Branch& branch : branches_) {
      ++branch_;
      for (const size_t i : branch.alive) paths_[i] = branch.paths[i];
      follow(branch.alive);
    }
  }

  /// Traces paths from their second vertex on.
  void follow(LaneSet alive) {
    if (record_) part_ = &record_->scattered[size_t(branch_)];
    constexpr int kPolled = 64;  // vertices
    for (vertex_ = 1; !alive.empty(); ++vertex_) {
      if (vertex_ % kPolled == 0) check_stop();
      alive = advance(meet(alive));
    }
    part_ = nullptr;
  }

  /// One vertex of all paths, whose rays have met surfaces: adds emission, samples lights and BSDFs. Returns the paths
  /// that continue.
  LaneSet advance(const LaneSet& met) {
    arena_.reset();
    LaneSet passed;
    const LaneSet scattering = look(met, passed);
    if (settings_.sample_lights && !selector_.empty()) add_sampled_lights(scattering);
    return scatter(scattering, passed);
  }

  LaneSet begin() {
    for (Branch& branch : branches_) branch.alive = LaneSet();
    const LaneSet lanes(bundle_->wanted);
    for (const size_t i : lanes) {
      Path& path = paths_[i];
      path.ray = bundle_->rays[i];
      path.lambda = bundle_->lambda[i];
      path.throughput = SampledSpectrum(1);
      path.scatter_pdf = INFINITY;
      path.light_samples = 1;
      path.scattered_rays = 1;
      path.share = 1;
      path.power_factor = 1;
      path.depth = 0;
      path.is_wide = false;
      path.previous = {path.ray.o, {0, 0, 1}};
      PathResult& result = bundle_->results[i];
      result.radiance = {};
      result.first.is_hit = false;
      result.scatterings = 0;
      result.escaped = false;
      result.fault = {};
    }
    return lanes;
  }

  /// Key of this vertex of a path.
  VertexKey key_of(size_t lane) const { return {hash_key(bundle_->keys[lane], place_of_numbers())}; }

  /// Index of this vertex for random numbers. Those of a branch lie beyond those of any path of the one before.
  uint64_t place_of_numbers() const { return uint64_t(vertex_) + (uint64_t(branch_) << 21); }

  /// Intersects camera rays in packets, whose rays do not depend on which results are wanted: a sample does not depend
  /// on which other samples are rendered.
  LaneSet meet_first(const LaneSet& alive) {
    uint32_t hits = 0;
    for (size_t first = 0; first < kMost; first += kWidth) {
      if ((bundle_->wanted >> first & kPacket) == 0) continue;
      const RayPacket packet{&bundle_->rays[first], &bundle_->keys[first], bundle_->lanes >> first & kPacket};
      hits |= world_.intersect(packet, &points_[first]) << first;
    }
    count_rays(alive);
    return after_rays(alive, hits);
  }

  /// Intersects the next rays one by one, since they are incoherent.
  LaneSet meet(const LaneSet& alive) {
    uint32_t hits = 0;
    for (const size_t i : alive)
      if (world_.intersect(paths_[i].ray, key_of(i).of(Use::ray), points_[i])) hits |= 1u << i;
    count_rays(alive);
    return after_rays(alive, hits);
  }

  /// Returns the paths that hit a surface; the others receive the environment's radiance and end.
  LaneSet after_rays(const LaneSet& alive, uint32_t hits) {
    for (const size_t i : LaneSet(alive.bits() & ~hits)) {
      if (!settings_.hides_background || paths_[i].depth > 0) add_environment(i);
      if (branch_ == 0) bundle_->results[i].escaped = true;
    }
    return LaneSet(alive.bits() & hits);
  }

  /// Adds emission and evaluates materials. Returns the paths that may be scattered; a path that hits an invisible
  /// surface goes to `passed`.
  LaneSet look(const LaneSet& met, LaneSet& passed) {
    LaneSet scattering;
    for (const size_t i : met) {
      const SurfacePoint& point = points_[i];
      at_ = &point;
      Path& path = paths_[i];
      path.key = key_of(i);
      if (point.light) add_emission(i);
      const Bsdf* bsdf = point.material->evaluate(point.hit, path.lambda, arena_);
      if (!bsdf) {
        pass(point.hit, path);
        if (vertex_ - path.depth < kMostPassed) passed.add(i);
        continue;
      }
      if (path.depth == 0) set_first_hit(point, bundle_->results[i].first);
      if (path.depth >= settings_.max_depth) continue;
      if (settings_.regularizes && path.is_wide) bsdf = bsdf->regularized(arena_);
      bsdfs_[i].set(*bsdf, point.hit, -path.ray.d);
      path.scattered_rays = vertex_ == 0 ? scattered_rays(point, *bsdf) : 1;
      scattering.add(i);
    }
    at_ = nullptr;
    return scattering;
  }

  /// Number of rays that a first vertex scatters.
  int scattered_rays(const SurfacePoint& point, const Bsdf& bsdf) const {
    const auto& by_material = settings_.rays_by_material;
    const int rays = point.material_id < by_material.size() ? by_material[point.material_id] : settings_.scattered_rays;
    return rays > 1 && is_rough(bsdf) ? rays : 1;
  }

  void add(size_t lane, const Light& light, const SampledSpectrum& radiance, float weight) {
    if (!radiance.is_physical() || !(weight >= 0)) return blame(lane, light);
    const SampledSpectrum added = paths_[lane].throughput * radiance * (weight * paths_[lane].share);
    bundle_->results[lane].radiance += added;
    if (part_) part_->radiance[lane] += added;
  }

  void count_rays(const LaneSet& lanes) {
    bundle_->traced += lanes.size();
    if (!part_) return;
    for (const size_t i : lanes) ++part_->rays[i];
  }

  /// The film counts a sample that is not a number, and takes it as black.
  void blame(size_t lane, PlugInFault fault) {
    bundle_->results[lane].fault = fault;
    bundle_->results[lane].radiance = SampledSpectrum(std::numeric_limits<float>::quiet_NaN());
  }
  void blame(size_t lane, const Light& light) { blame(lane, {PlugInFault::Kind::light, uint32_t(light.index())}); }
  void blame_material(size_t lane) { blame(lane, {PlugInFault::Kind::material, points_[lane].material_id}); }

  void add_environment(size_t lane) {
    const Path& path = paths_[lane];
    for (const EnvironmentLight* light : world_.environment())
      add(lane, *light, light->radiance(path.previous.p, path.ray.d, path.lambda),
          weight_of(*light, path, [&] { return light->compensated_pdf(path.previous.p, path.ray.d); }));
  }

  void add_emission(size_t lane) {
    const SurfacePoint& point = points_[lane];
    const Path& path = paths_[lane];
    const AreaLight& light = *point.light;
    const EmittingPoint at{point.hit.p, point.hit.ng, point.hit.at.uv};
    add(lane, light, light.radiance(at, -path.ray.d, path.lambda),
        weight_of(light, path, [&] { return light.pdf(path.previous.p, at); }));
  }

  /// MIS weight of emission hit by a scattered ray (power heuristic, Veach and Guibas 1995).
  template <class Pdf>
  float weight_of(const Light& light, const Path& path, const Pdf& light_pdf) const {
    if (std::isinf(path.scatter_pdf)) return 1;
    const float pdf = light_pdf() * selector_.probability(light, path.previous);
    if (!(pdf >= 0)) return pdf;  // `add` reports it
    return power_heuristic(path.scatter_pdf, path.light_samples * pdf);
  }

  /// Contribution of a light sample to a path if it is not occluded.
  struct Lit {
    SampledSpectrum radiance;
    float weight;
    const Light* light;
  };

  /// Adds light samples, at the first vertex of each path as many as the settings say.
  void add_sampled_lights(const LaneSet& lanes) {
    const int count = vertex_ == 0 && selector_.has_extent() ? settings_.light_samples : 1;
    for (const size_t i : lanes) paths_[i].light_samples = float(count);
    // Random numbers that no light of the scene uses are not generated.
    const SplitLanes split(lanes, count);
    if (selector_.has_choice()) draw(split, Number::light, numbers_);
    if (selector_.has_extent()) draw(split, Number::on_light, pairs_);
    for (int which = 0; which < count; ++which) {
      if (record_ && vertex_ == 0) {
        part_ = &record_->lights[size_t(which)];
        part_->paths = lanes;
      }
      add_light_samples(lanes, which);
    }
  }

  void add_light_samples(const LaneSet& lanes, int which) {
    LaneSet lit, coherent;
    for (const size_t i : lanes) {
      const SurfacePoint& point = points_[i];
      at_ = &point;
      const Path& path = paths_[i];
      const float number = selector_.has_choice() ? numbers_[size_t(which)][i] : 0;
      Vec2 on_light = selector_.has_extent() ? pairs_[size_t(which)][i] : Vec2{number, 0};
      const auto chosen = selector_.choose({point.hit.p, point.hit.ng}, on_light.x, number);
      if (!chosen) continue;
      const auto [light, probability] = *chosen;
      const auto sample = light->sample_compensated(point.hit.p, on_light, path.lambda);
      if (!sample || sample->radiance.is_black()) continue;
      if (!is_possible(*sample)) {
        blame(i, *light);
        continue;
      }
      float scatter_pdf = 0;
      const SampledSpectrum f_cos = bsdfs_[i].f_cos(sample->wi, path.key.stream(Use::light_bsdf, which), scatter_pdf);
      if (!f_cos.is_physical() || !(scatter_pdf >= 0 && scatter_pdf < INFINITY)) {
        blame_material(i);
        continue;
      }
      if (f_cos.is_black()) continue;
      scatter_pdf *= float(path.scattered_rays);
      const float light_pdf = path.light_samples * sample->pdf * probability;
      const float weight = light->is_delta() ? 1 : power_heuristic(light_pdf, scatter_pdf);
      lit_[i].radiance = f_cos * sample->radiance;
      lit_[i].weight = weight / light_pdf;
      lit_[i].light = light;
      set_shadow_ray(point.hit, *sample, path.ray.time, shadow_rays_[i]);
      shadow_keys_[i] = path.key.of(Use::shadow_ray, which);
      lit.add(i);
      if (vertex_ == 0 && (light->is_delta() || !light->is_distant() || light->sun())) coherent.add(i);
    }
    at_ = nullptr;
    count_rays(lit);
    const uint32_t dark = occluded_together(coherent) | occluded(LaneSet(lit.bits() & ~coherent.bits()));
    for (const size_t i : LaneSet(lit.bits() & ~dark)) add(i, *lit_[i].light, lit_[i].radiance, lit_[i].weight);
  }

  /// Returns the mask of the occluded paths: shadow rays one by one.
  uint32_t occluded(const LaneSet& lit) const {
    uint32_t dark = 0;
    for (const size_t i : lit)
      if (world_.occluded(shadow_rays_[i], shadow_keys_[i])) dark |= 1u << i;
    return dark;
  }

  /// The same in packets, for coherent rays: toward delta or nearby lights, or mostly to a sun, from the first hit.
  uint32_t occluded_together(const LaneSet& lit) const {
    uint32_t dark = 0;
    for (size_t first = 0; first < kMost; first += kWidth) {
      const RayPacket packet{&shadow_rays_[first], &shadow_keys_[first], lit.bits() >> first & kPacket};
      if (packet.lanes != 0) dark |= world_.occluded(packet) << first;
    }
    return dark;
  }

  /// Shadow ray from the offset origin to the same point of the light, ending just short of its surface.
  static void set_shadow_ray(const Hit& hit, const LightSample& sample, float time, Ray& ray) {
    const bool is_distant = std::isinf(sample.distance);
    ray.o = offset_origin(hit, sample.wi);
    ray.d = is_distant ? sample.wi : hit.p + sample.wi * sample.distance - ray.o;
    ray.t_max = is_distant ? INFINITY : kBeforeLight;
    ray.time = time;
  }

  static void set_ray(const Hit& hit, const Vec3& direction, Path& path) {
    path.previous.p = hit.p;
    path.previous.n = hit.ng;
    path.ray.o = offset_origin(hit, direction);
    path.ray.d = direction;
    path.ray.t_max = INFINITY;
  }

  /// Continues a path straight through an invisible surface. Shadow rays are blocked by it, so no light sample competes
  /// with emission behind it.
  static void pass(const Hit& hit, Path& path) {
    path.scatter_pdf = INFINITY;
    set_ray(hit, path.ray.d, path);
  }

  /// Samples the next directions. Returns the paths that continue, including those in `passed`.
  LaneSet scatter(const LaneSet& lanes, const LaneSet& passed) {
    SplitLanes split;
    for (const size_t i : lanes) split.add(i, paths_[i].scattered_rays);
    draw(split, Number::lobe, numbers_);
    draw(split, Number::direction, pairs_);
    LaneSet alive = passed;
    for (const size_t i : lanes) {
      Path& path = paths_[i];
      at_ = &points_[i];
      if (path.depth == 0 && bundle_->albedo_samples > 0)
        bundle_->results[i].first.albedo = first_albedo(points_[i], path.lambda, -path.ray.d, bundle_->albedo_samples,
                                                        path.key.of(Use::albedo), arena_);
      for (int which = 0; record_ && vertex_ == 0 && which < path.scattered_rays; ++which)
        record_->scattered[size_t(which)].paths.add(i);
      for (int which = 1; which < path.scattered_rays; ++which) {
        Branch& branch = branches_[size_t(which) - 1];
        branch.paths[i] = path;
        if (scatter(i, which, branch.paths[i])) branch.alive.add(i);
      }
      if (scatter(i, 0, path)) alive.add(i);
      if (branch_ == 0) bundle_->results[i].scatterings = path.depth;
    }
    at_ = nullptr;
    return alive;
  }

  /// Samples the direction of one of the rays that a vertex scatters. Returns false if the path ends.
  bool scatter(size_t lane, int which, Path& path) {
    const float uc = numbers_[size_t(which)][lane];
    const Vec2 u = pairs_[size_t(which)][lane];
    LocalBsdf::Sample sample;
    if (!bsdfs_[lane].sample(uc, u, path.key.stream(Use::bsdf, which), sample)) return false;
    if (!is_possible(sample)) {
      blame_material(lane);
      return false;
    }
    path.throughput *= sample.weight;
    path.share /= float(path.scattered_rays);
    path.power_factor *= sample.power_factor;
    path.lambda.retire_black_lanes(path.throughput);
    path.is_wide = path.is_wide || !sample.is_specular;
    path.scatter_pdf =
        !settings_.sample_lights || sample.is_specular ? INFINITY : sample.pdf * float(path.scattered_rays);
    set_ray(points_[lane].hit, sample.wi, path);
    if (ends(path)) return false;
    ++path.depth;
    return true;
  }

  /// Returns whether the path ends here; Russian roulette divides the survivors' throughput by their probability. It
  /// starts after the fifth scattering: earlier, the few survivors add more noise in dark regions than the time saved
  /// is worth.
  bool ends(Path& path) const {
    if (path.throughput.is_black()) return true;
    if (settings_.cut_off_attenuation) return attenuation(path) * path.power_factor < settings_.cutoff;
    const float survival = path.throughput.max() * path.power_factor;
    if (path.depth < kSafeScatterings - 1 || survival >= 1) return false;
    if (path.key.stream(Use::roulette).uniform() >= survival) return true;
    path.throughput *= 1 / survival;
    return false;
  }

  /// The paper's luminance of the attenuation if the lanes are its three colours; else the mean.
  float attenuation(const Path& path) const {
    const auto shares = world_.wavelengths().luminance_shares();
    if (shares.empty()) return mean(path.throughput, path.lambda);
    float sum = 0;
    for (size_t i = 0; i < shares.size(); ++i) sum += shares[i] * path.throughput.v[i];
    return sum;
  }

  /// Draws the sampler's numbers of this vertex.
  template <class T>
  void draw(const SplitLanes& lanes, Number number, SplitNumbers<T>& u) const {
    draw_numbers(*bundle_, place_of_numbers(), number, lanes, record_ != nullptr, u);
  }

  const World& world_;
  const LightSelector& selector_;
  const PathSettings& settings_;
  PathBundle* bundle_ = nullptr;       ///< current bundle
  const SurfacePoint* at_ = nullptr;   ///< surface whose plug-ins are called
  SplitRecord* record_;                ///< or nullptr
  SplitRecord::Part* part_ = nullptr;  ///< to which rays and radiance belong, if they are recorded
  Arena arena_;
  /// Index of the vertex for random numbers; invisible surfaces count too.
  int vertex_ = 0;
  int branch_ = 0;  ///< index of the rays, among those of each first vertex, that are followed
  /// Paths whose first vertices scatter several rays, with one of the rays after the first.
  struct Branch {
    LaneSet alive;
    std::array<Path, kMost> paths;
  };
  std::array<Branch, kMostSplit - 1> branches_;
  std::array<Path, kMost> paths_;
  std::array<SurfacePoint, kMost> points_;
  std::array<LocalBsdf, kMost> bsdfs_;
  std::array<Lit, kMost> lit_;
  std::array<Ray, kMost> shadow_rays_;
  std::array<uint64_t, kMost> shadow_keys_{};
  SplitNumbers<float> numbers_;
  SplitNumbers<Vec2> pairs_;
};

}  // namespace

std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings, SplitRecord* record) {
  return std::make_unique<PathTracer>(world, selector, settings, record);
}

}  // namespace frond
