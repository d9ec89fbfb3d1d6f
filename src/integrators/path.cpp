#include <algorithm>
#include <array>
#include <cmath>

#include "core/integrator.h"
#include "core/sampling.h"
#include "integrators/light_selector.h"

namespace frond {
namespace {

/// Streams of one path vertex, told apart by what they are for.
enum class Use : uint64_t { shadow_ray, light_bsdf, bsdf, roulette };

/// Keys of the random numbers of one vertex: those of its rays, and streams by use.
struct VertexKey {
  uint64_t value;

  uint64_t of(Use use) const { return hash_key(value, uint64_t(use)); }
  RandomStream stream(Use use) const { return RandomStream(of(use)); }
};

/// A path on its way from the camera to the lights.
struct Path {
  Ray ray;
  SampledWavelengths lambda;
  SampledSpectrum throughput{1};
  /// Density of the last direction, for the balance with light sampling; infinite where no light sample competes.
  float scatter_pdf = INFINITY;
  LightSelector::Place previous{ray.o, {0, 0, 1}};  ///< the last vertex
  PathResult result;

  void add(const SampledSpectrum& radiance, float weight) { result.radiance += throughput * radiance * weight; }
};

/// A BSDF at a hit, in world space. The geometric normal decides the side: where the shading normal would put a
/// direction on the other one, nothing is scattered there.
class LocalBsdf {
 public:
  LocalBsdf(const Bsdf& bsdf, const Hit& hit, const Vec3& wo) : bsdf_(bsdf), hit_(hit), frame_(hit.shading) {
    // A shading normal that turns away from the viewer is bent back to the side that the ray met.
    if (dot(wo, frame_.z) * dot(wo, hit.ng) <= 0) frame_ = Frame::around(hit.ng);
    wo_ = frame_.to_local(wo);
  }

  SampledSpectrum f_cos(const Vec3& wi_world, RandomStream rng, float& pdf) const {
    const Vec3 wi = frame_.to_local(wi_world);
    if (!agrees(wi_world, wi)) return {};
    pdf = bsdf_.pdf(wo_, wi);
    return pdf > 0 ? bsdf_.f(wo_, wi, rng) * std::abs(wi.z) : SampledSpectrum();
  }

  /// `sample.wi` comes back in world space.
  std::optional<BsdfSample> sample(float uc, Vec2 u, RandomStream rng, SampledSpectrum& weight, float& mis_pdf) const {
    auto s = bsdf_.sample(wo_, uc, u, rng);
    if (!s) return {};
    const Vec3 local = s->wi;
    s->wi = frame_.to_world(local);
    if (!agrees(s->wi, local)) return {};
    weight = s->f * (std::abs(local.z) / s->pdf);
    mis_pdf = s->pdf_is_approximate ? bsdf_.pdf(wo_, local) : s->pdf;
    return s;
  }

 private:
  bool agrees(const Vec3& world, const Vec3& local) const { return local.z * dot(world, hit_.ng) > 0; }

  const Bsdf& bsdf_;
  const Hit& hit_;
  Frame frame_;
  Vec3 wo_;
};

constexpr std::string_view kTerminations[] = {"roulette", "attenuation"};
constexpr std::string_view kLightSamplers[] = {"uniform", "power", "bvh"};
constexpr Param kPath[] = {
    {.name = "maxdepth",
     .kind = ParamKind::integer,
     .default_value = 5,
     .range = {0, 1 << 20},
     .doc = "Longest path, in scattering events."},
    {.name = "sampledirect",
     .kind = ParamKind::boolean,
     .default_value = true,
     .doc = "Sample the lights at every hit; false: follow scattered rays alone."},
    {.name = "lightsampler",
     .kind = ParamKind::string,
     .default_value = std::string_view("bvh"),
     .doc = "How a hit chooses its light. bvh: by what lights may give there.",
     .choices = kLightSamplers},
    {.name = "termination",
     .kind = ParamKind::string,
     .default_value = std::string_view("roulette"),
     .doc = "roulette: unbiased. attenuation: a path ends when the luminance of its attenuation (where wavelengths are "
            "not smpte's, the mean) falls below the cutoff, as in the paper; biased.",
     .choices = kTerminations},
    {.name = "cutoff",
     .kind = ParamKind::real,
     .default_value = 0.01,
     .range = {0, 1},
     .doc = "Attenuation below which a path ends."},
};

/// Unidirectional path tracing; light sampling and BSDF sampling combined by the power heuristic.
class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const Params& p)
      : max_depth_(p.integer("maxdepth")),
        sample_lights_(p.boolean("sampledirect")),
        strategy_(
            LightSelector::Strategy(std::ranges::find(kLightSamplers, p.string("lightsampler")) - kLightSamplers)),
        cut_off_attenuation_(p.string("termination") == "attenuation"),
        cutoff_(float(p.real("cutoff"))) {}

  void prepare(const World& world) override { selector_ = LightSelector(world, strategy_); }

  PathResult trace(const World& world, const Ray& camera_ray, SampledWavelengths lambda,
                   PathContext& context) const override {
    Path path{.ray = camera_ray, .lambda = lambda, .result = {}};
    // Vertices are counted for their random numbers, scattering events for the depth: a surface that is not there makes
    // the one without the other.
    for (int vertex = 0, depth = 0; vertex - depth <= kMostPassed; ++vertex) {
      const VertexKey key{hash_key(context.key, uint64_t(vertex))};
      SurfacePoint point;
      ++context.rays;
      if (!world.intersect(path.ray, key.value, point)) {
        add_environment(world, path);
        path.result.escaped = true;
        break;
      }
      if (point.light) add_emission(point, path);
      context.arena.reset();
      const Bsdf* bsdf = point.material->evaluate(point.hit, path.lambda, context.arena);
      if (!bsdf) {
        pass(point.hit, path);
        continue;
      }
      if (depth == 0) path.result.first = first_hit(point);
      if (depth >= max_depth_) break;
      const LocalBsdf local(*bsdf, point.hit, -path.ray.d);
      if (sample_lights_ && !selector_.empty()) add_sampled_light(world, point.hit, local, key, path, context);
      if (!scatter(point.hit, local, key, path, context)) break;
      if (depth == 0) path.result.first.albedo = path.throughput;
      if (ends(world, depth, key, path)) break;
      path.result.scatterings = ++depth;
    }
    return path.result;
  }

 private:
  static FirstHit first_hit(const SurfacePoint& point) {
    return {.is_hit = true,
            .is_leaf = point.material->is_leaf(),
            .material = point.material_id,
            .instance = point.instance_id,
            .p = point.hit.p,
            .n = point.hit.shading.z,
            .albedo = {}};
  }

  void add_environment(const World& world, Path& path) const {
    for (const EnvironmentLight* light : world.environment())
      path.add(light->radiance(path.ray.d, path.lambda), weight_of(*light, path, light->competing_pdf(path.ray.d)));
  }

  void add_emission(const SurfacePoint& point, Path& path) const {
    const AreaLight& light = *point.light;
    const float pdf = light.pdf(point.hit.ng, path.ray.d, length(point.hit.p - path.previous.p));
    path.add(light.radiance(point.hit.ng, -path.ray.d, path.lambda), weight_of(light, path, pdf));
  }

  /// Weight of light met by a scattered ray.
  float weight_of(const Light& light, const Path& path, float light_pdf) const {
    if (std::isinf(path.scatter_pdf)) return 1;
    return power_heuristic(path.scatter_pdf, light_pdf * selector_.probability(light, path.previous));
  }

  void add_sampled_light(const World& world, const Hit& hit, const LocalBsdf& bsdf, VertexKey key, Path& path,
                         PathContext& context) const {
    // Numbers that no light of the scene would read are not made; which are made is the same for every sample.
    const float choice = selector_.has_choice() ? context.sampler.get1d() : 0;
    const Vec2 u = selector_.has_extent() ? context.sampler.get2d() : Vec2{};
    const auto chosen = selector_.choose({hit.p, hit.ng}, choice);
    if (!chosen) return;
    const auto [light, probability] = *chosen;
    const auto sample = light->sample_competing(hit.p, u, path.lambda);
    if (!sample || sample->radiance.is_black()) return;
    float scatter_pdf = 0;
    const SampledSpectrum f_cos = bsdf.f_cos(sample->wi, key.stream(Use::light_bsdf), scatter_pdf);
    if (f_cos.is_black()) return;
    ++context.rays;
    if (world.occluded(shadow_ray(hit, *sample), key.of(Use::shadow_ray))) return;
    const float light_pdf = sample->pdf * probability;
    const float weight = light->is_delta() ? 1 : power_heuristic(light_pdf, scatter_pdf);
    path.add(f_cos * sample->radiance, weight / light_pdf);
  }

  /// From the lifted origin to the same point of the light, and just short of its surface.
  static Ray shadow_ray(const Hit& hit, const LightSample& sample) {
    const Vec3 origin = offset_origin(hit, sample.wi);
    if (std::isinf(sample.distance)) return {origin, sample.wi};
    return {origin, hit.p + sample.wi * sample.distance - origin, 1 - 0x1p-13f};
  }

  /// Straight on through a surface that is not there. Shadow rays stop at it, so no light sample competes with what
  /// lies behind.
  static void pass(const Hit& hit, Path& path) {
    path.scatter_pdf = INFINITY;
    path.previous = {hit.p, hit.ng};
    path.ray = {offset_origin(hit, path.ray.d), path.ray.d};
  }

  /// Turns the path into the next direction. False where nothing is scattered.
  bool scatter(const Hit& hit, const LocalBsdf& bsdf, VertexKey key, Path& path, PathContext& context) const {
    const float uc = context.sampler.get1d();
    const Vec2 u = context.sampler.get2d();
    SampledSpectrum weight;
    const auto sample = bsdf.sample(uc, u, key.stream(Use::bsdf), weight, path.scatter_pdf);
    if (!sample) return false;
    path.throughput *= weight;
    path.lambda.retire_black_lanes(path.throughput);
    if (!sample_lights_ || any(sample->flags & Lobes::specular)) path.scatter_pdf = INFINITY;
    path.previous = {hit.p, hit.ng};
    path.ray = {offset_origin(hit, sample->wi), sample->wi};
    return true;
  }

  /// Whether the path ends here; roulette rewards the survivors. It begins after the third scattering: what is left to
  /// scattered rays, as an even sky is, is found by those before.
  bool ends(const World& world, int depth, VertexKey key, Path& path) const {
    if (path.throughput.is_black()) return true;
    if (cut_off_attenuation_) return attenuation(world, path) < cutoff_;
    const float survival = path.throughput.max();
    if (depth < 2 || survival >= 1) return false;
    if (key.stream(Use::roulette).uniform() >= survival) return true;
    path.throughput *= 1 / survival;
    return false;
  }

  /// The paper's luminance of the attenuation where the lanes are its three colours; the mean elsewhere.
  static float attenuation(const World& world, const Path& path) {
    const auto shares = world.wavelengths().luminance_shares();
    if (shares.empty()) return mean(path.throughput, path.lambda);
    float sum = 0;
    for (size_t i = 0; i < shares.size(); ++i) sum += shares[i] * path.throughput.v[i];
    return sum;
  }

  /// Surfaces that are not there, in one path: rounding might have a ray meet the same one for ever.
  static constexpr int kMostPassed = 1000;

  int max_depth_;
  bool sample_lights_;
  LightSelector::Strategy strategy_;
  bool cut_off_attenuation_;
  float cutoff_;
  LightSelector selector_;
};

std::unique_ptr<Integrator> make_path(const Params& p) { return std::make_unique<PathIntegrator>(p); }

}  // namespace

extern const IntegratorInfo path_integrator{
    {"integrator", "path", "Path tracing with light sampling and multiple importance sampling.",
     "Kajiya 1986; Veach and Guibas 1995", kPath},
    make_path};

}  // namespace frond
