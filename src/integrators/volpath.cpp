#include <algorithm>
#include <array>
#include <cmath>

#include "core/integrator.h"
#include "core/math/sampling.h"
#include "integrators/path_parts.h"
#include "integrators/path_state.h"
#include "integrators/probe.h"
#include "integrators/shadow_ray.h"
#include "integrators/vertex_numbers.h"

namespace frond {
namespace {

constexpr Param kVolPath[] = {
    {.name = "maxdepth",
     .kind = ParamKind::integer,
     .default_value = 5,
     .range = {0, 1 << 20},
     .doc = "Longest path, in scattering events at surfaces and in media."},
    {.name = "sampledirect",
     .kind = ParamKind::boolean,
     .default_value = true,
     .doc = "Sample lights at every scattering; false: only scattered rays find lights."},
    {.name = "lightsampler",
     .kind = ParamKind::string,
     .default_value = std::string_view("bvh"),
     .doc = "Selection of a light. bvh: by a light tree's estimate of its contribution.",
     .choices = kLightSamplers},
    kRegularize,
    kHideBackground,
};

/// Values of the parameters.
struct VolPathSettings {
  int max_depth;
  bool sample_lights;
  bool regularizes;
  bool hides_background;
  SubsurfaceMaterials subsurface = {};
};

/// Traces one path after the other. A loop iteration is one ray: its medium, then the surface that it hits.
class VolPathTracer final : public Tracer {
 public:
  VolPathTracer(const World& world, const LightSelector& selector, const VolPathSettings& settings)
      : world_(world), selector_(selector), settings_(settings) {}

  void trace(PathBundle& bundle) override {
    bundle_ = &bundle;
    for (lane_ = 0; lane_ < PathBundle::kSize; ++lane_) {
      if (!(bundle.wanted >> lane_ & 1)) continue;
      trace_path();
    }
  }

 private:
  void trace_path() {
    begin_path();
    SurfacePoint point;
    for (vertex_ = 0; vertex_ - depth_ <= kMostPassed; ++vertex_) {
      poll_();
      key_ = vertex_key(bundle_->keys[lane_], uint64_t(vertex_));
      arena_.reset();
      ++bundle_->traced;
      const bool is_hit = world_.intersect(ray_, key_.key(Use::ray), point);
      if (medium_) {
        const Ray in_medium{from_, ray_.d, is_hit ? length(point.hit.p - from_) : INFINITY};
        const Passage passage = track_medium(in_medium);
        if (passage == Passage::ended) return;
        if (passage == Passage::scattered) continue;
      }
      if (!is_hit) {
        result().escaped = true;
        if (!settings_.hides_background || depth_ > 0) add_environment();
        return;
      }
      if (!name_material_in_errors(point, [&] { return process_hit(point); })) return;
    }
  }

  void begin_path() {
    result().reset();
    ray_ = bundle_->rays[lane_];
    ray_.d = normalize(ray_.d);
    from_ = ray_.o;
    lambda_ = bundle_->lambda[lane_];
    SampledSpectrum in_use;
    for (int i = 0; i < lambda_.count; ++i) in_use[i] = 1;
    // Independent of lambda_.hero: weights count all lanes, also after refraction has left one.
    RandomStream rng(hash_key(bundle_->keys[lane_], ~uint64_t{0}));
    path_ = {in_use, in_use, in_use, std::min(int(rng.uniform() * float(lambda_.count)), lambda_.count - 1)};
    medium_ = world_.camera_medium();
    is_specular_ = true;
    is_wide_ = false;
    power_factor_ = 1;
    depth_ = 0;
    previous_ = {ray_.o, {}};
  }

  enum class Passage : uint8_t { passed, scattered, ended };

  /// Delta tracking through the medium of the ray. After a scattering, the next ray is set.
  Passage track_medium(const Ray& ray) {
    RandomStream rng = key_.stream(Use::medium);
    Passage passage = Passage::passed;
    SampledSpectrum t;
    const bool emits = medium_->is_emissive();
    const auto collide = [&](const Vec3& p, const SampledSpectrum& majorant, const SampledSpectrum& t_maj) {
      const MediumPoint at = medium_->properties(p, lambda_);
      const int h = path_.hero;
      if (emits && depth_ < settings_.max_depth) add_medium_emission(at, majorant, t_maj);
      const float absorbed = at.sigma_a[h] / majorant[h], scattered = at.sigma_s[h] / majorant[h];
      const float event = rng.uniform();
      if (event < absorbed) {
        passage = Passage::ended;
        return false;
      }
      if (event < absorbed + scattered) {
        if (depth_ >= settings_.max_depth) {
          passage = Passage::ended;
          return false;
        }
        const SampledSpectrum by = t_maj * at.sigma_s * (1 / (t_maj[h] * at.sigma_s[h]));
        path_.multiply(by, by, by);
        passage = scatter_in_medium(p, at, rng) ? Passage::scattered : Passage::ended;
        return false;
      }
      const SampledSpectrum null = null_coefficient(majorant, at);
      const float density = t_maj[h] * null[h];
      if (density > 0)
        path_.multiply(t_maj * null * (1 / density), t_maj * null * (1 / density), t_maj * majorant * (1 / density));
      else
        path_.beta = {};
      if (!path_.beta.is_black()) return true;
      passage = Passage::ended;
      return false;
    };
    if (!track(*medium_, ray, lambda_, path_.hero, draw<float>(Number::distance), rng, poll_, t, collide))
      return passage;
    const float density = t[path_.hero];
    if (!(density > 0)) return Passage::ended;
    // Shadow rays pass a homogeneous medium with probability 1, others without a collision (ShadowRay).
    const SampledSpectrum of_light = medium_->is_homogeneous() ? SampledSpectrum(1) : t;
    path_.multiply(t * (1 / density), t * (1 / density), of_light * (1 / density));
    return path_.beta.is_black() ? Passage::ended : Passage::passed;
  }

  void add_medium_emission(const MediumPoint& at, const SampledSpectrum& majorant, const SampledSpectrum& t_maj) {
    const float density = t_maj[path_.hero] * majorant[path_.hero];
    const float sum = mean(path_.r_u * majorant * t_maj, lambda_);
    if (density > 0 && sum > 0) result().radiance += path_.beta * t_maj * at.emission * (1 / sum);
  }

  bool scatter_in_medium(const Vec3& p, const MediumPoint& at, RandomStream& rng) {
    const Vec3 w = ray_.d;
    const LightSelector::LitPoint place{p, {}};
    if (settings_.sample_lights && !selector_.empty())
      add_sampled_light(place, [&](const LightSample& sample, ShadowRay& shadow) {
        shadow.begin({p, {}}, medium_);
        const SampledSpectrum value = at.phase.value(dot(w, sample.wi));
        return Scattering{value, value};
      });
    const Vec3 wi = at.phase.sample(w, path_.hero, draw<Vec2>(Number::direction), rng);
    const SampledSpectrum value = at.phase.value(dot(w, wi));
    const float density = value[path_.hero];
    if (!(density > 0)) return false;
    const SampledSpectrum before = path_.r_u;
    path_.beta *= value * (1 / density);
    path_.r_u *= value * (1 / density);
    path_.r_l = before * (1 / density);
    is_specular_ = !settings_.sample_lights;
    is_wide_ = true;
    previous_ = place;
    ray_ = {p, wi, INFINITY, ray_.time};
    from_ = p;
    return survives();
  }

  /// Emission, light sample and scattering at a surface. Returns false if the path ends.
  bool process_hit(const SurfacePoint& point) {
    if (point.light) add_emission(point);
    const Bsdf* bsdf = point.material->evaluate(point.hit, lambda_, arena_);
    if (!bsdf) {
      leave_surface(point, ray_.d);
      return true;
    }
    if (depth_ == 0) {
      FirstHit& first = result().first;
      set_first_hit(point, first);
      if (bundle_->albedo_samples > 0)
        first.albedo = first_albedo(point, lambda_, -ray_.d, bundle_->albedo_samples, key_.key(Use::albedo), arena_);
    }
    if (depth_ >= settings_.max_depth) return false;
    if (settings_.regularizes && is_wide_) bsdf = bsdf->regularized(arena_);
    Vec3 wi;
    if (!scatter(point, *bsdf, -ray_.d, wi)) return false;
    if (!enters_material(settings_.subsurface, point, -ray_.d, wi))
      leave_surface(point, wi);
    else if (!pass_material(point))
      return false;
    return survives();
  }

  /// Continues a path that has entered a material where it leaves it. Returns false if the path ends.
  bool pass_material(const SurfacePoint& point) {
    key_ = vertex_key(bundle_->keys[lane_], uint64_t(++vertex_));
    const int vertex = vertex_ | kProbeVertex;
    const Bssrdf& bssrdf = settings_.subsurface[point.material_id]->bssrdf(point.hit, lambda_, arena_);
    if (!find_exit(world_, bssrdf, point.material_id, draw_number<float>(*bundle_, lane_, vertex, Number::lobe),
                   draw_number<Vec2>(*bundle_, lane_, vertex, Number::direction),
                   vertex_key(bundle_->keys[lane_], uint64_t(vertex)), ray_.time, bundle_->traced, exit_))
      return false;
    path_.beta *= exit_.weight;
    lambda_.retire_black_lanes(path_.beta);
    Vec3 wi;
    if (!scatter(exit_.point, bssrdf.exit(), exit_.point.hit.shading.z, wi)) return false;
    leave_surface(exit_.point, wi);
    return true;
  }

  /// Samples a light and the BSDF of a surface, which is seen along `wo`. Returns false if the path ends.
  bool scatter(const SurfacePoint& point, const Bsdf& bsdf, const Vec3& wo, Vec3& wi) {
    LocalBsdf local;
    local.set(bsdf, point.hit, wo);
    const LightSelector::LitPoint place{point.hit.p, point.hit.ng};
    if (settings_.sample_lights && !selector_.empty())
      add_sampled_light(place, [&](const LightSample& sample, ShadowRay& shadow) {
        if (enters_material(settings_.subsurface, point, wo, sample.wi)) return Scattering{};
        shadow.begin({point.hit.p, offset_origin(point.hit, sample.wi) - point.hit.p},
                     medium_beyond(world_, point, sample.wi, medium_));
        float pdf = 0;
        const SampledSpectrum f = local.f_cos(sample.wi, key_.stream(Use::light_bsdf), pdf);
        if (!f.is_physical() || !(pdf >= 0 && pdf < INFINITY)) {
          result().record_fault(point);
          return Scattering{};
        }
        return Scattering{f, SampledSpectrum(pdf)};
      });
    LocalBsdf::Sample sample;
    if (!local.sample(draw<float>(Number::lobe), draw<Vec2>(Number::direction), key_.stream(Use::bsdf), sample))
      return false;
    if (!is_valid_sample(sample)) {
      result().record_fault(point);
      return false;
    }
    path_.beta *= sample.weight;
    path_.r_l = path_.r_u * (1 / sample.pdf);
    power_factor_ *= sample.eta_scale;
    lambda_.retire_black_lanes(path_.beta);
    is_wide_ = is_wide_ || !sample.is_specular;
    is_specular_ = !settings_.sample_lights || sample.is_specular;
    previous_ = place;
    wi = sample.wi;
    return true;
  }

  /// Continues in the direction `w`.
  void leave_surface(const SurfacePoint& point, const Vec3& w) {
    medium_ = medium_beyond(world_, point, w, medium_);
    from_ = point.hit.p;
    set_leaving_ray(point.hit, w, ray_);
  }

  /// Value of the scattering toward a light sample, with the cosine at surfaces, and its density by wavelength.
  struct Scattering {
    SampledSpectrum value, density;
  };

  /// Samples a light and adds its contribution. `scatter(sample, shadow)` begins the shadow ray and returns the
  /// scattering.
  template <class Scatter>
  void add_sampled_light(const LightSelector::LitPoint& place, const Scatter& scatter) {
    const float number = selector_.has_choice() ? draw<float>(Number::light) : 0;
    Vec2 on_light = selector_.has_extent() ? draw<Vec2>(Number::on_light) : Vec2{number, 0};
    const auto chosen = selector_.choose(place, on_light.x, number);
    if (!chosen) return;
    const auto [light, probability] = *chosen;
    const auto sample = light->sample_compensated(place.p, on_light, lambda_);
    if (!sample || sample->radiance.is_black()) return;
    if (!is_valid_sample(*sample)) return result().record_fault(*light);
    ShadowRay shadow(world_, lambda_, path_.hero, ray_.time, poll_);
    const Scattering scattering = scatter(*sample, shadow);
    if (scattering.value.is_black()) return;
    if (!shadow.trace(*sample, key_.key(Use::shadow_ray), shadow_arena_, bundle_->traced)) return;
    const SampledSpectrum of_light = path_.r_u * shadow.path().r_l * (sample->pdf * probability);
    const SampledSpectrum of_scattering =
        light->is_delta() ? SampledSpectrum() : path_.r_u * shadow.path().r_u * scattering.density;
    const float sum = mean(of_light + of_scattering, lambda_);
    if (sum > 0) result().radiance += path_.beta * scattering.value * shadow.path().beta * sample->radiance * (1 / sum);
  }

  /// Adds emitted radiance, weighted by the balance heuristic over wavelengths and light samples.
  template <class Pdf>
  void add_radiance(const Light& light, const SampledSpectrum& radiance, const Pdf& light_pdf) {
    const float pdf = is_specular_ ? 0 : light_pdf() * selector_.probability(light, previous_);
    if (!radiance.is_physical() || !(pdf >= 0)) return result().record_fault(light);
    const SampledSpectrum density = path_.r_u + path_.r_l * pdf;
    const float sum = mean(density, lambda_);
    if (sum > 0) result().radiance += path_.beta * radiance * (1 / sum);
  }
  void add_environment() {
    for (const EnvironmentLight* light : world_.environment())
      add_radiance(*light, light->radiance(previous_.p, ray_.d, lambda_),
                   [&] { return light->compensated_pdf(previous_.p, ray_.d); });
  }
  void add_emission(const SurfacePoint& point) {
    const EmittingPoint at{point.hit.p, point.hit.ng, point.hit.at.uv};
    add_radiance(*point.light, point.light->radiance(at, -ray_.d, lambda_),
                 [&] { return point.light->pdf(previous_.p, at); });
  }

  /// Russian roulette as in the integrator path, on the throughput relative to its density; counts a scattering that
  /// survives.
  bool survives() {
    const float density = mean(path_.r_u, lambda_);
    if (path_.beta.is_black() || !(density > 0)) return false;
    RandomStream random = key_.stream(Use::roulette);
    if (depth_ + 1 >= kSafeScatterings &&
        !survives_roulette(path_.beta.max() * power_factor_ / density, 1, random, path_.beta))
      return false;
    result().scatterings = ++depth_;
    return true;
  }

  PathResult& result() { return bundle_->results[lane_]; }
  /// Draws a number, or a pair of numbers, of the sampler for this vertex.
  template <class T>
  T draw(Number number) const {
    return draw_number<T>(*bundle_, lane_, vertex_, number);
  }

  const World& world_;
  const LightSelector& selector_;
  const VolPathSettings& settings_;
  PathBundle* bundle_ = nullptr;
  size_t lane_ = 0;  ///< of the bundle
  Arena arena_, shadow_arena_;
  StopPoll poll_;  ///< counts rays and null collisions
  // State of the path.
  int vertex_ = 0, depth_ = 0;
  VertexKey key_{};
  Ray ray_;
  Vec3 from_;  ///< vertex from which the ray leaves: distances in a medium are counted from it, not from the ray's
               ///< origin
  SampledWavelengths lambda_;
  SpectralPath path_;
  MaterialExit exit_;
  const Medium* medium_ = nullptr;
  bool is_wide_ = false;     ///< a scattering was not specular
  bool is_specular_ = true;  ///< no light sample competes with the next emission
  float power_factor_ = 1;   ///< factor by which refraction alone has divided the throughput
  LightSelector::LitPoint previous_;
};

/// Path tracing in participating media.
class VolPathIntegrator final : public Integrator, public SubsurfaceIntegrator {
 public:
  explicit VolPathIntegrator(const Params& p)
      : settings_{p.integer("maxdepth"), p.boolean("sampledirect"), p.boolean("regularize"),
                  p.boolean("hidebackground")},
        strategy_(light_strategy(p)) {}

  void set_subsurface(SubsurfaceMaterials by_material) override { settings_.subsurface = std::move(by_material); }
  void prepare(const World& world) override { selector_ = LightSelector(world, strategy_); }
  std::unique_ptr<Tracer> tracer(const World& world) const override {
    return std::make_unique<VolPathTracer>(world, selector_, settings_);
  }

 private:
  VolPathSettings settings_;
  LightSelector::Strategy strategy_;
  LightSelector selector_;
};

std::unique_ptr<Integrator> make_volpath(const Params& p) { return std::make_unique<VolPathIntegrator>(p); }

}  // namespace

extern const IntegratorInfo volpath_integrator{
    {"integrator", "volpath", "Path tracing in participating media, by delta and ratio tracking.",
     "Miller et al. 2019; pbrt-v4", kVolPath},
    make_volpath};

}  // namespace frond
