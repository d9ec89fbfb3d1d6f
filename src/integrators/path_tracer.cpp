#include "integrators/path_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/sampling.h"
#include "core/parallel.h"
#include "integrators/path_parts.h"
#include "integrators/path_state.h"
#include "integrators/probe.h"
#include "integrators/vertex_numbers.h"

namespace frond {
namespace {

/// Recorder of renders: records nothing (SplitRecord).
struct NoRecord {
  static constexpr bool kSeparatesSamples = false;
  void begin() {}
  void select_light_sample(int, const LaneSet&) {}
  void select_scattered_ray(int) {}
  void add_path(size_t, int) {}
  void add_scattered(size_t, int, float) {}
  void add_radiance(size_t, const SampledSpectrum&) {}
  void add_rays(const LaneSet&) {}
};

/// Traces the paths of a bundle together, one vertex after the other. `Record`: NoRecord or SplitRecord&.
template <class Record>
class PathTracer final : public Tracer {
 public:
  PathTracer(const World& world, const LightSelector& selector, const PathSettings& settings, Record record)
      : world_(world), selector_(selector), settings_(settings), record_(record) {}

  /// Traces all paths with the first rays that their first vertices scatter, then with the second ones.
  void trace(PathBundle& bundle) override {
    bundle_ = &bundle;
    record_.begin();
    branch_ = 0;
    vertex_ = 0;
    trace_from_second_vertex(process_hits(intersect_camera_rays(begin_paths())));
    for (const Branch& branch : branches_) {
      ++branch_;
      for (const size_t i : branch.alive) paths_[i] = branch.paths[i];
      trace_from_second_vertex(branch.alive);
    }
  }

 private:
  static constexpr size_t kSize = PathBundle::kSize, kWidth = RayPacket::kWidth;
  static constexpr uint32_t kPacket = (1u << kWidth) - 1;  ///< lanes of one packet

  void trace_from_second_vertex(LaneSet alive) {
    record_.select_scattered_ray(branch_);
    constexpr int kPolled = 64;  // vertices
    for (vertex_ = 1; !alive.empty(); ++vertex_) {
      if (vertex_ % kPolled == 0) check_stop();
      alive = process_hits(intersect(alive));
    }
  }

  /// One vertex of all paths, whose rays hit surfaces: adds emission, samples lights and BSDFs. Returns the paths that
  /// continue.
  LaneSet process_hits(const LaneSet& hits) {
    arena_.reset();
    LaneSet passing;
    const LaneSet scattering = evaluate_materials(hits, passing);
    if (settings_.sample_lights && !selector_.empty()) add_sampled_lights(scattering);
    return sample_bsdfs(scattering, passing);
  }

  LaneSet begin_paths() {
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
      path.split_weight = 1;
      path.eta_scale = 1;
      path.depth = 0;
      path.any_nonspecular = false;
      path.is_exit = false;
      path.previous = {path.ray.o, {0, 0, 1}};
      bundle_->results[i].reset();
    }
    return lanes;
  }

  /// Index of the current vertices for random numbers. Each branch has a range of 2^21 indices.
  uint64_t vertex_index() const { return uint64_t(vertex_) + (uint64_t(branch_) << 21); }
  VertexKey current_key(size_t lane) const { return vertex_key(bundle_->keys[lane], vertex_index()); }

  /// Intersects camera rays in packets, whose rays do not depend on which results are wanted: a sample does not depend
  /// on which other samples are rendered.
  LaneSet intersect_camera_rays(const LaneSet& alive) {
    uint32_t hits = 0;
    for (size_t first = 0; first < kSize; first += kWidth) {
      if ((bundle_->wanted >> first & kPacket) == 0) continue;
      const RayPacket packet{&bundle_->rays[first], &bundle_->keys[first], bundle_->lanes >> first & kPacket};
      hits |= world_.intersect(packet, &points_[first]) << first;
    }
    return end_escaped(alive, hits);
  }

  /// Intersects the next rays one by one, since they are incoherent.
  LaneSet intersect(const LaneSet& alive) {
    uint32_t hits = 0;
    for (const size_t i : alive)
      if (paths_[i].is_exit) [[unlikely]]
        points_[i] = exits_[size_t(branch_)][i].point, hits |= 1u << i;
      else if (world_.intersect(paths_[i].ray, current_key(i).key(Use::ray), points_[i]))
        hits |= 1u << i;
    return end_escaped(alive, hits);
  }

  /// Returns the paths whose rays hit a surface; the others receive the environment's radiance and end.
  LaneSet end_escaped(const LaneSet& alive, uint32_t hits) {
    count_rays(alive);
    for (const size_t i : LaneSet(alive.bits() & ~hits)) {
      if (!settings_.hides_background || paths_[i].depth > 0) add_environment(i);
      if (branch_ == 0) bundle_->results[i].escaped = true;
    }
    return LaneSet(alive.bits() & hits);
  }

  /// Adds emission and evaluates materials. Returns the paths that may be scattered; a path that hits a surface without
  /// a BSDF is added to `passing`.
  LaneSet evaluate_materials(const LaneSet& hits, LaneSet& passing) {
    LaneSet scattering;
    for (const size_t i : hits) name_material_in_errors(points_[i], [&] { evaluate_material(i, scattering, passing); });
    return scattering;
  }

  void evaluate_material(size_t lane, LaneSet& scattering, LaneSet& passing) {
    const SurfacePoint& point = points_[lane];
    Path& path = paths_[lane];
    path.key = current_key(lane);
    if (path.is_exit) [[unlikely]] {
      const Bssrdf& bssrdf = settings_.subsurface[point.material_id]->bssrdf(point.hit, path.lambda, arena_);
      bsdfs_[lane].set(bssrdf.exit(), point.hit, point.hit.shading.z);
      path.scattered_rays = 1;
      scattering.add(lane);
      return;
    }
    if (point.light) add_emission(lane);
    const Bsdf* bsdf = point.material->evaluate(point.hit, path.lambda, arena_);
    if (!bsdf) {
      pass_through(point.hit, path);
      if (vertex_ - path.depth < kMostPassed) passing.add(lane);
      return;
    }
    if (path.depth == 0) set_first_hit(point, bundle_->results[lane].first);
    if (path.depth >= settings_.max_depth) return;
    if (settings_.regularizes && path.any_nonspecular) bsdf = bsdf->regularized(arena_);
    bsdfs_[lane].set(*bsdf, point.hit, -path.ray.d);
    path.scattered_rays = vertex_ == 0 ? first_scattered_rays(point, *bsdf) : 1;
    scattering.add(lane);
  }

  /// Number of rays that a first vertex scatters.
  int first_scattered_rays(const SurfacePoint& point, const Bsdf& bsdf) const {
    const auto& by_material = settings_.rays_by_material;
    const int rays = point.material_id < by_material.size() ? by_material[point.material_id] : settings_.scattered_rays;
    return rays > 1 && is_rough(bsdf) ? rays : 1;
  }

  void add_radiance(size_t lane, const Light& light, const SampledSpectrum& radiance, float weight) {
    if (!radiance.is_physical() || !(weight >= 0)) return bundle_->results[lane].record_fault(light);
    const SampledSpectrum added = paths_[lane].throughput * radiance * (weight * paths_[lane].split_weight);
    bundle_->results[lane].radiance += added;
    record_.add_radiance(lane, added);
  }

  void count_rays(const LaneSet& lanes) {
    bundle_->traced += lanes.size();
    record_.add_rays(lanes);
  }

  void add_environment(size_t lane) {
    const Path& path = paths_[lane];
    for (const EnvironmentLight* light : world_.environment())
      add_radiance(
          lane, *light, light->radiance(path.previous.p, path.ray.d, path.lambda),
          scattering_weight(*light, path, [&] { return light->compensated_pdf(path.previous.p, path.ray.d); }));
  }

  void add_emission(size_t lane) {
    const SurfacePoint& point = points_[lane];
    const Path& path = paths_[lane];
    const AreaLight& light = *point.light;
    const EmittingPoint at{point.hit.p, point.hit.ng, point.hit.at.uv};
    add_radiance(lane, light, light.radiance(at, -path.ray.d, path.lambda),
                 scattering_weight(light, path, [&] { return light.pdf(path.previous.p, at); }));
  }

  /// MIS weight of the emission that a scattered ray hits (power heuristic, Veach and Guibas 1995).
  template <class Pdf>
  float scattering_weight(const Light& light, const Path& path, const Pdf& light_pdf) const {
    if (std::isinf(path.scatter_pdf)) return 1;
    const float pdf = light_pdf() * selector_.probability(light, path.previous);
    if (!(pdf >= 0)) return pdf;  // add_radiance records the fault
    return power_heuristic(path.scatter_pdf, path.light_samples * pdf);
  }

  /// Contribution of a light sample to a path if it is not occluded.
  struct LightContribution {
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
      if (vertex_ == 0) record_.select_light_sample(which, lanes);
      LaneSet lit, coherent;
      for (const size_t i : lanes) name_material_in_errors(points_[i], [&] { sample_light(i, which, lit, coherent); });
      count_rays(lit);
      const uint32_t occluded = occluded_packets(coherent) | occluded_rays(LaneSet(lit.bits() & ~coherent.bits()));
      for (const size_t i : LaneSet(lit.bits() & ~occluded))
        add_radiance(i, *lights_[i].light, lights_[i].radiance, lights_[i].weight);
    }
  }

  /// Samples a light and evaluates the BSDF in its direction. If the light contributes, sets the contribution and the
  /// shadow ray, and adds the path to `lit`, and to `coherent` if the shadow rays of neighbouring paths are coherent:
  /// from the first hit toward delta or nearby lights, or mostly to a sun.
  void sample_light(size_t lane, int which, LaneSet& lit, LaneSet& coherent) {
    const SurfacePoint& point = points_[lane];
    const Path& path = paths_[lane];
    const float number = selector_.has_choice() ? numbers_[size_t(which)][lane] : 0;
    Vec2 on_light = selector_.has_extent() ? pairs_[size_t(which)][lane] : Vec2{number, 0};
    const auto chosen = selector_.choose({point.hit.p, point.hit.ng}, on_light.x, number);
    if (!chosen) return;
    const auto [light, probability] = *chosen;
    const auto sample = light->sample_compensated(point.hit.p, on_light, path.lambda);
    if (!sample || sample->radiance.is_black()) return;
    if (!is_valid_sample(*sample)) return bundle_->results[lane].record_fault(*light);
    if (enters_material(settings_.subsurface, point, -path.ray.d, sample->wi)) return;
    float scatter_pdf = 0;
    const SampledSpectrum f_cos = bsdfs_[lane].f_cos(sample->wi, path.key.stream(Use::light_bsdf, which), scatter_pdf);
    if (!f_cos.is_physical() || !(scatter_pdf >= 0 && scatter_pdf < INFINITY))
      return bundle_->results[lane].record_fault(point);
    if (f_cos.is_black()) return;
    scatter_pdf *= float(path.scattered_rays);
    const float light_pdf = path.light_samples * sample->pdf * probability;
    const float weight = light->is_delta() ? 1 : power_heuristic(light_pdf, scatter_pdf);
    lights_[lane].radiance = f_cos * sample->radiance;
    lights_[lane].weight = weight / light_pdf;
    lights_[lane].light = light;
    set_shadow_ray(point.hit, *sample, path.ray.time, shadow_rays_[lane]);
    shadow_keys_[lane] = path.key.key(Use::shadow_ray, which);
    lit.add(lane);
    if (vertex_ == 0 && (light->is_delta() || !light->is_distant() || light->sun())) coherent.add(lane);
  }

  /// Returns the mask of the paths whose shadow rays are occluded. Traces them one by one.
  uint32_t occluded_rays(const LaneSet& lit) const {
    uint32_t occluded = 0;
    for (const size_t i : lit)
      if (world_.occluded(shadow_rays_[i], shadow_keys_[i])) occluded |= 1u << i;
    return occluded;
  }

  /// The same for coherent rays, in packets.
  uint32_t occluded_packets(const LaneSet& lit) const {
    uint32_t occluded = 0;
    for (size_t first = 0; first < kSize; first += kWidth) {
      const RayPacket packet{&shadow_rays_[first], &shadow_keys_[first], lit.bits() >> first & kPacket};
      if (packet.lanes != 0) occluded |= world_.occluded(packet) << first;
    }
    return occluded;
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
    set_leaving_ray(hit, direction, path.ray);
  }

  /// Continues a path straight through a surface without a BSDF. Such surfaces block shadow rays, so no light sample
  /// competes with emission behind them.
  static void pass_through(const Hit& hit, Path& path) {
    path.scatter_pdf = INFINITY;
    set_ray(hit, path.ray.d, path);
  }

  /// Samples the next directions. Returns the paths that continue, including those in `passing`.
  LaneSet sample_bsdfs(const LaneSet& lanes, const LaneSet& passing) {
    SplitLanes split;
    for (const size_t i : lanes) split.add(i, paths_[i].scattered_rays);
    draw(split, Number::lobe, numbers_);
    draw(split, Number::direction, pairs_);
    LaneSet alive = passing;
    for (const size_t i : lanes) name_material_in_errors(points_[i], [&] { sample_bsdf(i, alive); });
    return alive;
  }

  /// Samples the rays that a vertex scatters. Adds the path to `alive` if it continues with the first of them.
  void sample_bsdf(size_t lane, LaneSet& alive) {
    Path& path = paths_[lane];
    PathResult& result = bundle_->results[lane];
    if (path.depth == 0 && bundle_->albedo_samples > 0)
      result.first.albedo = first_albedo(points_[lane], path.lambda, -path.ray.d, bundle_->albedo_samples,
                                         path.key.key(Use::albedo), arena_);
    if (vertex_ == 0) record_.add_path(lane, path.scattered_rays);
    for (int which = 1; which < path.scattered_rays; ++which) {
      Branch& branch = branches_[size_t(which) - 1];
      branch.paths[lane] = path;
      if (scatter(lane, which, branch.paths[lane])) branch.alive.add(lane);
    }
    if (scatter(lane, 0, path)) alive.add(lane);
    if (branch_ == 0) result.scatterings = path.depth;
  }

  /// Samples the direction of one of the rays that a vertex scatters. Returns false if the path ends.
  bool scatter(size_t lane, int which, Path& path) {
    const float uc = numbers_[size_t(which)][lane];
    const Vec2 u = pairs_[size_t(which)][lane];
    LocalBsdf::Sample sample;
    if (!bsdfs_[lane].sample(uc, u, path.key.stream(Use::bsdf, which), sample)) return false;
    if (!is_valid_sample(sample)) {
      bundle_->results[lane].record_fault(points_[lane]);
      return false;
    }
    path.throughput *= sample.weight;
    path.split_weight /= float(path.scattered_rays);
    path.eta_scale *= sample.eta_scale;
    path.lambda.retire_black_lanes(path.throughput);
    path.any_nonspecular = path.any_nonspecular || !sample.is_specular;
    path.scatter_pdf =
        !settings_.sample_lights || sample.is_specular ? INFINITY : sample.pdf * float(path.scattered_rays);
    const bool is_exit = path.is_exit;
    path.is_exit = enters_material(settings_.subsurface, points_[lane], -path.ray.d, sample.wi);
    if (path.is_exit) [[unlikely]] {
      if (!pass_material(lane, which, path)) return false;
    } else {
      set_ray(points_[lane].hit, sample.wi, path);
    }
    if (vertex_ == 0) record_.add_scattered(lane, which, share_of(path));
    if (!survives(lane, which, path)) return false;
    path.depth += is_exit ? 0 : 1;  // as in pbrt-v4, entry and exit are one scattering
    return true;
  }

  /// Finds the vertex at which a path leaves a material that it has entered. Returns false if the path ends.
  [[gnu::noinline]] bool pass_material(size_t lane, int which, Path& path) {
    const SurfacePoint& point = points_[lane];
    const uint64_t vertex = vertex_index() | uint64_t(kProbeVertex);
    const PixelSamples& s = bundle_->samples;
    const PixelSamples one{s.x, s.y, uint64_t(path.scattered_rays) * (s.first + lane) + uint64_t(which), 1};
    float uc;
    Vec2 u;
    get_numbers(bundle_->sampler, one, dimension_of(*bundle_, vertex, Number::lobe), &uc);
    get_numbers(bundle_->sampler, one, dimension_of(*bundle_, vertex, Number::direction), &u);
    const Bssrdf& bssrdf = settings_.subsurface[point.material_id]->bssrdf(point.hit, path.lambda, arena_);
    MaterialExit& exit = exits_[size_t(branch_ + which)][lane];
    const VertexKey key = vertex_key(bundle_->keys[lane], vertex + (uint64_t(which) << 21));
    if (!find_exit(world_, bssrdf, point.material_id, uc, u, key, path.ray.time, bundle_->traced, exit)) return false;
    path.throughput *= exit.weight;
    path.lambda.retire_black_lanes(path.throughput);
    return true;
  }

  /// Factor on the radiance that the path's next ray finds, without that of its wavelengths: the largest over the
  /// lanes, as if refraction had not changed it.
  static float share_of(const Path& path) { return path.throughput.max() * path.eta_scale * path.split_weight; }

  /// Returns false if the path ends here, by Russian roulette or by the cutoff.
  bool survives(size_t lane, int which, Path& path) const {
    if (path.throughput.is_black()) return false;
    if (settings_.cut_off_attenuation) return attenuation(path) * path.eta_scale >= settings_.cutoff;
    float full = 1;
    if (path.depth < kSafeScatterings - 1)
      full = std::min(full, mean(bundle_->results[lane].radiance, path.lambda) / settings_.roulette.mean);
    RandomStream random = path.key.stream(Use::roulette, which);
    return survives_roulette(settings_.roulette.scale * share_of(path), full, random, path.throughput);
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
    draw_numbers(*bundle_, vertex_index(), number, lanes, std::remove_reference_t<Record>::kSeparatesSamples, u);
  }

  const World& world_;
  const LightSelector& selector_;
  const PathSettings& settings_;
  Record record_;
  PathBundle* bundle_ = nullptr;  ///< current bundle
  Arena arena_;
  int vertex_ = 0;  ///< index of the current vertices along their paths, surfaces without a BSDF included
  int branch_ = 0;  ///< which of the rays that each first vertex scatters is being traced: 0 or 1
  /// Paths whose first vertices scatter several rays, with one of the rays after the first.
  struct Branch {
    LaneSet alive;
    std::array<Path, kSize> paths;
  };
  std::array<Branch, kMostSplit - 1> branches_;
  std::array<Path, kSize> paths_;
  std::array<SurfacePoint, kSize> points_;
  std::array<LocalBsdf, kSize> bsdfs_;
  std::array<LightContribution, kSize> lights_;
  std::array<Ray, kSize> shadow_rays_;
  std::array<uint64_t, kSize> shadow_keys_{};
  SplitNumbers<float> numbers_;
  SplitNumbers<Vec2> pairs_;
  /// Next vertices of paths with Path::is_exit, by branch.
  std::array<std::array<MaterialExit, kSize>, kMostSplit> exits_;
};

}  // namespace

std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings) {
  return std::make_unique<PathTracer<NoRecord>>(world, selector, settings, NoRecord());
}

std::unique_ptr<Tracer> make_recording_tracer(const World& world, const LightSelector& selector,
                                              const PathSettings& settings, SplitRecord& record) {
  return std::make_unique<PathTracer<SplitRecord&>>(world, selector, settings, record);
}

}  // namespace frond
