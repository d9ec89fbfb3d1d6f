#include "integrators/fluorescence_tracer.h"

#include <cmath>

#include "core/math/sampling.h"
#include "core/stop.h"
#include "integrators/path_parts.h"
#include "integrators/path_state.h"
#include "integrators/vertex_numbers.h"

namespace frond {
namespace {

/// Light at a surface, lane by lane: radiance times the factors of its sample, from the direction `wi` (world space).
struct ArrivingLight {
  Vec3 wi;
  SampledSpectrum value;
};

/// Bispectral path tracing (Mojzik et al. 2018, "Handling Fluorescence in a Uni-directional Spectral Path Tracer"). A
/// path from the camera carries wavelengths of emission. At each surface that fluoresces it gathers light at four
/// wavelengths of excitation: by a light sample, and along a path at these wavelengths. Light that fluorescence has
/// excited excites no more.
class FluorescenceTracer final : public Tracer {
 public:
  FluorescenceTracer(const World& world, const LightSelector& selector, const PathSettings& settings,
                     const EmittingMaterials& materials, std::unique_ptr<Tracer> reflected)
      : world_(world),
        selector_(selector),
        settings_(settings),
        materials_(materials),
        reflected_(std::move(reflected)),
        has_colors_(world.wavelengths().bands().empty()),
        first_band_(first_fluorescence_band(world.wavelengths())) {}

  void trace(PathBundle& bundle) override {
    uint32_t emitted = 0;
    for (const size_t i : LaneSet(bundle.wanted))
      if (bundle.lambda[i].band[0] >= first_band_) emitted |= 1u << i;  // all, if there are no bands
    const uint32_t wanted = bundle.wanted;
    if (const uint32_t others = has_colors_ ? wanted : wanted & ~emitted) {
      bundle.wanted = others;
      reflected_->trace(bundle);
      bundle.wanted = wanted;
    }
    bundle_ = &bundle;
    for (const size_t i : LaneSet(emitted)) {
      lane_ = i;
      trace_emission();
    }
  }

 private:
  /// One path at the wavelengths of emission.
  void trace_emission() {
    if (!has_colors_) result().reset();
    ray_ = bundle_->rays[lane_];
    lambda_ = bundle_->lambda[lane_];
    throughput_ = SampledSpectrum(1);
    eta_scale_ = 1;
    depth_ = 0;
    SurfacePoint point;
    for (vertex_ = 0; vertex_ - depth_ <= kMostPassed; ++vertex_) {
      poll_();
      key_ = vertex_key(bundle_->keys[lane_], uint64_t(vertex_));
      ++bundle_->traced;
      if (!world_.intersect(ray_, key_.key(Use::ray), point)) {
        if (!has_colors_) result().escaped = true;
        return;
      }
      arena_.reset();
      if (!name_material_in_errors(point, [&] { return process_hit(point); })) return;
    }
  }

  /// Adds the emission of a surface and scatters the path. Returns false if the path ends.
  bool process_hit(const SurfacePoint& point) {
    const Bsdf* bsdf = point.material->evaluate(point.hit, lambda_, arena_);
    if (!bsdf) {
      set_leaving_ray(point.hit, ray_.d, ray_);
      return true;
    }
    if (depth_ == 0 && !has_colors_) set_first_hit(point, result().first);
    if (depth_ >= settings_.max_depth) return false;
    if (const EmittingMaterials::Emitter* emitter = materials_.find(point.material_id)) gather(point, *emitter);
    LocalBsdf local;
    local.set(*bsdf, point.hit, -ray_.d);
    LocalBsdf::Sample sample;
    if (!local.sample(draw<float>(Number::lobe), draw<Vec2>(Number::direction), key_.stream(Use::bsdf), sample))
      return false;
    if (!is_valid_sample(sample)) {
      result().record_fault(point);
      return false;
    }
    throughput_ *= sample.weight;
    eta_scale_ *= sample.eta_scale;
    lambda_.retire_black_lanes(throughput_);
    set_leaving_ray(point.hit, sample.wi, ray_);
    if (throughput_.is_black()) return false;
    RandomStream random = key_.stream(Use::roulette);
    if (depth_ + 1 >= kSafeScatterings && !survives_roulette(throughput_.max() * eta_scale_, 1, random, throughput_))
      return false;
    ++depth_;
    if (!has_colors_) result().scatterings = depth_;
    return true;
  }

  /// Adds the light that a surface emits toward the path: that of a light sample, and that of a path at wavelengths of
  /// excitation, which has a cosine distribution on both sides, as a leaf is excited from both.
  void gather(const SurfacePoint& point, const EmittingMaterials::Emitter& emitter) {
    const SampledWavelengths excitation = emitter.excitation.sample(draw<float>(Number::distance));
    // The less light of the surface reaches the camera, the fewer paths are followed.
    const float share = depth_ == 0 ? 1 : std::min(1.f, throughput_.max() * eta_scale_);
    const auto density = [&](const Vec3& wi) { return share * std::abs(dot(point.hit.shading.z, wi)) / (2 * kPi); };
    if (settings_.sample_lights && !selector_.empty()) {
      const LightNumbers u{draw<float>(Number::light), draw<Vec2>(Number::on_light)};
      const auto light = sample_light(point, excitation, u, key_, [&](const Vec3& wi, float& pdf) {
        pdf = density(wi);
        return SampledSpectrum(std::abs(dot(point.hit.shading.z, wi)));
      });
      if (light) add_emission(point, emitter, excitation, *light, 0);
    }
    RandomStream random = key_.stream(Use::bsdf, 1);
    if (random.uniform() >= share) return;
    Vec3 local = sample_cosine_hemisphere({random.uniform(), random.uniform()});
    if (random.uniform() < 0.5f) local.z = -local.z;
    if (local.z == 0) return;
    const Vec3 wi = point.hit.shading.to_world(local);
    const SampledSpectrum radiance = excite(point, wi, excitation, density(wi));
    if (!radiance.is_black()) add_emission(point, emitter, excitation, {wi, radiance * (2 * kPi / share)}, 1);
  }

  /// Adds what the surface emits for this light, in units of energy: photons have the factor excitation over emission
  /// wavelength.
  void add_emission(const SurfacePoint& point, const EmittingMaterials::Emitter& emitter,
                    const SampledWavelengths& excitation, const ArrivingLight& light, int which) {
    const Frame& frame = point.hit.shading;
    const Vec3 wo = frame.to_local(-ray_.d), wi = frame.to_local(light.wi);
    RandomStream random = key_.stream(Use::light_bsdf, which);
    for (int f = 0; f < lambda_.count; ++f) {
      const auto emission_nm = double(lambda_.nm[size_t(f)]);
      if (!lambda_.is_active(f) || !kEmission_nm.contains(emission_nm)) continue;
      double sum = 0;
      for (int e = 0; e < excitation.count; ++e) {
        const auto excitation_nm = double(excitation.nm[size_t(e)]);
        if (light.value[e] == 0) continue;
        sum += emitter.fluorescence->f(wo, wi, emission_nm, excitation_nm, random) * double(light.value[e]) *
               excitation_nm / (emission_nm * double(excitation.pdf[size_t(e)]));
      }
      const auto radiance = float(sum / excitation.count);
      if (!(radiance >= 0 && radiance < INFINITY)) return result().record_fault(point);
      result().radiance[f] += throughput_[f] * radiance;
    }
  }

  struct LightNumbers {
    float which;
    Vec2 on_light;
  };

  /// Samples a light and traces the shadow ray. `scatter(wi, pdf)` returns the factor of the surface, with the cosine,
  /// and sets the density of a scattered ray in this direction. Nothing if no light arrives.
  template <class Scatter>
  std::optional<ArrivingLight> sample_light(const SurfacePoint& point, const SampledWavelengths& lambda, LightNumbers u,
                                            const VertexKey& key, const Scatter& scatter) {
    if (!selector_.has_extent()) u.on_light = {u.which, 0};
    const auto chosen = selector_.choose({point.hit.p, point.hit.ng}, u.on_light.x, u.which);
    if (!chosen) return {};
    const auto [light, probability] = *chosen;
    const auto sample = light->sample_compensated(point.hit.p, u.on_light, lambda);
    if (!sample || sample->radiance.is_black()) return {};
    if (!is_valid_sample(*sample)) {
      result().record_fault(*light);
      return {};
    }
    float scatter_pdf = 0;
    const SampledSpectrum factor = scatter(sample->wi, scatter_pdf);
    if (!factor.is_physical() || !(scatter_pdf >= 0 && scatter_pdf < INFINITY)) {
      result().record_fault(point);
      return {};
    }
    if (factor.is_black()) return {};
    Ray shadow = ray_;
    shadow.o = offset_origin(point.hit, sample->wi);
    const bool is_distant = std::isinf(sample->distance);
    shadow.d = is_distant ? sample->wi : point.hit.p + sample->wi * sample->distance - shadow.o;
    shadow.t_max = is_distant ? INFINITY : kBeforeLight;
    ++bundle_->traced;
    if (world_.occluded(shadow, key.key(Use::shadow_ray))) return {};
    const float light_pdf = sample->pdf * probability;
    const float weight = light->is_delta() ? 1 : power_heuristic(light_pdf, scatter_pdf);
    return ArrivingLight{sample->wi, factor * sample->radiance * (weight / light_pdf)};
  }

  /// A path at wavelengths of excitation.
  struct ExcitationPath {
    Ray ray;
    SampledWavelengths lambda;
    float scatter_pdf;  ///< density of the last direction, for MIS; infinite if no light sample competes
    int depth;          ///< scattering events since the camera
    SampledSpectrum throughput{1}, radiance{};
    float eta_scale = 1;  ///< factor by which refraction alone has divided the throughput
    LightSelector::LitPoint previous{};

    void leave(const SurfacePoint& point, const Vec3& direction) {
      previous = {point.hit.p, point.hit.ng};
      set_leaving_ray(point.hit, direction, ray);
    }
  };

  /// Returns the radiance that arrives from `wi` at wavelengths of excitation: path tracing with light sampling.
  /// `scatter_pdf`: density of this direction, for MIS.
  SampledSpectrum excite(const SurfacePoint& from, const Vec3& wi, const SampledWavelengths& lambda,
                         float scatter_pdf) {
    ExcitationPath path{ray_, lambda, settings_.sample_lights ? scatter_pdf : INFINITY, depth_ + 1};
    path.leave(from, wi);
    const uint64_t path_key = hash_key(key_.value, uint64_t{kExcitation});
    SurfacePoint point;
    for (int vertex = 0; vertex - path.depth <= kMostPassed; ++vertex) {
      poll_();
      const VertexKey key = vertex_key(path_key, uint64_t(vertex));
      ++bundle_->traced;
      if (!world_.intersect(path.ray, key.key(Use::ray), point)) {
        for (const EnvironmentLight* light : world_.environment())
          add_light(path, *light, light->radiance(path.previous.p, path.ray.d, path.lambda),
                    [&] { return light->compensated_pdf(path.previous.p, path.ray.d); });
        break;
      }
      if (point.light) {
        const EmittingPoint at{point.hit.p, point.hit.ng, point.hit.at.uv};
        add_light(path, *point.light, point.light->radiance(at, -path.ray.d, path.lambda),
                  [&] { return point.light->pdf(path.previous.p, at); });
      }
      excitation_arena_.reset();
      if (!name_material_in_errors(point, [&] { return scatter(path, point, key); })) break;
    }
    return path.radiance;
  }

  /// Adds light that a path has met, with its MIS weight.
  template <class Pdf>
  void add_light(ExcitationPath& path, const Light& light, const SampledSpectrum& radiance, const Pdf& light_pdf) {
    float weight = 1;
    if (!std::isinf(path.scatter_pdf))
      weight = power_heuristic(path.scatter_pdf, light_pdf() * selector_.probability(light, path.previous));
    if (radiance.is_physical() && weight >= 0)
      path.radiance += path.throughput * radiance * weight;
    else
      result().record_fault(light);
  }

  /// Adds a light sample and scatters a path. Returns false if the path ends.
  bool scatter(ExcitationPath& path, const SurfacePoint& point, const VertexKey& key) {
    const Bsdf* bsdf = point.material->evaluate(point.hit, path.lambda, excitation_arena_);
    if (!bsdf) {
      path.scatter_pdf = INFINITY;
      path.leave(point, path.ray.d);
      return true;
    }
    if (path.depth >= settings_.max_depth) return false;
    LocalBsdf local;
    local.set(*bsdf, point.hit, -path.ray.d);
    RandomStream random = key.stream(Use::medium);
    if (settings_.sample_lights && !selector_.empty()) {
      const LightNumbers u{random.uniform(), {random.uniform(), random.uniform()}};
      const auto light = sample_light(point, path.lambda, u, key, [&](const Vec3& toward, float& pdf) {
        return local.f_cos(toward, key.stream(Use::light_bsdf), pdf);
      });
      if (light) path.radiance += path.throughput * light->value;
    }
    LocalBsdf::Sample sample;
    const float uc = random.uniform();
    const Vec2 u{random.uniform(), random.uniform()};
    if (!local.sample(uc, u, key.stream(Use::bsdf), sample)) return false;
    if (!is_valid_sample(sample)) {
      result().record_fault(point);
      return false;
    }
    path.throughput *= sample.weight;
    path.eta_scale *= sample.eta_scale;
    path.lambda.retire_black_lanes(path.throughput);
    path.scatter_pdf = !settings_.sample_lights || sample.is_specular ? INFINITY : sample.pdf;
    path.leave(point, sample.wi);
    ++path.depth;
    // A leaf scatters a tenth of the light that excites: roulette from the first scattering on.
    RandomStream roulette = key.stream(Use::roulette);
    return !path.throughput.is_black() &&
           survives_roulette(path.throughput.max() * path.eta_scale, 1, roulette, path.throughput);
  }

  static constexpr uint64_t kExcitation = 0x65786369;  ///< use of a vertex's key

  PathResult& result() { return bundle_->results[lane_]; }
  /// Draws a number, or a pair of numbers, of the sampler for this vertex; Number::distance for the excitation.
  template <class T>
  T draw(Number number) const {
    return draw_number<T>(*bundle_, lane_, vertex_, number);
  }

  const World& world_;
  const LightSelector& selector_;
  const PathSettings& settings_;
  const EmittingMaterials& materials_;
  std::unique_ptr<Tracer> reflected_;
  bool has_colors_;  ///< the emitted light is added to what `reflected_` has found
  size_t first_band_;
  PathBundle* bundle_ = nullptr;
  size_t lane_ = 0;  ///< of the bundle
  Arena arena_, excitation_arena_;
  StopPoll poll_;
  // State of the path at the wavelengths of emission.
  int vertex_ = 0, depth_ = 0;
  VertexKey key_{};
  Ray ray_;
  SampledWavelengths lambda_;
  SampledSpectrum throughput_;
  float eta_scale_ = 1;  ///< factor by which refraction alone has divided the throughput
};

/// Returns the sum of the lights' spectra, each with the mean 1 from 400 to 750 nm.
double light_at(const World& world, const std::vector<double>& means, double nm) {
  double sum = 0;
  for (size_t i = 0; i < means.size(); ++i)
    if (means[i] > 0) sum += double(world.lights()[i]->emission().at(float(nm))) / means[i];
  return sum;
}

std::vector<double> mean_emissions(const World& world) {
  std::vector<double> means;
  for (const Light* light : world.lights()) {
    double& mean = means.emplace_back();
    for (double nm = kExcitation_nm.min; nm <= kExcitation_nm.max; ++nm)
      mean += double(light->emission().at(float(nm)));
  }
  return means;
}

}  // namespace

EmittingMaterials::EmittingMaterials(const std::vector<std::shared_ptr<const Fluorescence>>& by_material,
                                     const World& world) {
  const std::vector<double> means = mean_emissions(world);
  for (const auto& fluorescence : by_material) {
    auto& emitter = emitters_.emplace_back();
    if (fluorescence)
      emitter.emplace(fluorescence, ExcitationSampler([&](double nm) {
                        return fluorescence->excitation(nm) * light_at(world, means, nm) * nm;
                      }));
  }
}

std::unique_ptr<Tracer> make_fluorescence_tracer(const World& world, const LightSelector& selector,
                                                 const PathSettings& settings, const EmittingMaterials& materials,
                                                 std::unique_ptr<Tracer> reflected) {
  return std::make_unique<FluorescenceTracer>(world, selector, settings, materials, std::move(reflected));
}

}  // namespace frond
