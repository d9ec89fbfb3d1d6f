#include <array>
#include <cmath>

#include "core/integrator.h"
#include "core/sampling.h"
#include "integrators/light_selector.h"
#include "integrators/registry.h"

namespace frond {
namespace {

/// Streams of one path vertex, told apart by what they are for.
enum class Use : uint64_t { ray, shadow_ray, light_bsdf, bsdf, roulette };

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
constexpr std::string_view kLightSamplers[] = {"power", "uniform"};
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
     .default_value = std::string_view("power"),
     .doc = "How a hit chooses its light.",
     .choices = kLightSamplers},
    {.name = "termination",
     .kind = ParamKind::string,
     .default_value = std::string_view("roulette"),
     .doc = "roulette: unbiased. attenuation: a path ends when the luminance of its attenuation falls below the "
            "cutoff, as in the paper; biased.",
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
        select_by_power_(p.string("lightsampler") == "power"),
        cut_off_attenuation_(p.string("termination") == "attenuation"),
        cutoff_(float(p.real("cutoff"))) {}

  void prepare(const World& world) override { selector_ = LightSelector(world, select_by_power_); }

  PathResult trace(const World& world, const Ray& camera_ray, SampledWavelengths lambda,
                   PathContext& context) const override {
    PathResult result;
    Ray ray = camera_ray;
    SampledSpectrum throughput(1);
    // Density of the last direction for the balance with light sampling; infinite where no light sample competes.
    float scatter_pdf = INFINITY;
    Vec3 previous = ray.o;
    for (int depth = 0;; ++depth) {
      const uint64_t vertex_key = hash_key(context.key, uint64_t(depth));
      const auto stream = [vertex_key](Use use) { return RandomStream(hash_key(vertex_key, uint64_t(use))); };
      SurfacePoint point;
      ++context.rays;
      if (!world.intersect(ray, vertex_key, point)) {
        for (const EnvironmentLight* light : world.environment())
          result.radiance +=
              throughput * light->radiance(ray.d, lambda) * weight_of(*light, scatter_pdf, light->pdf(ray.d));
        return result;
      }
      if (depth == 0) result.sees_leaf = point.material && point.material->is_leaf();
      if (point.light) {
        const float pdf = point.light->pdf(point.hit.ng, ray.d, distance_between(previous, point.hit.p));
        result.radiance += throughput * point.light->radiance(point.hit.ng, -ray.d, lambda) *
                           weight_of(*point.light, scatter_pdf, pdf);
      }
      if (depth >= max_depth_ || !point.material) return result;

      context.arena.reset();
      const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, context.arena);
      if (!bsdf) return result;
      const LocalBsdf local(*bsdf, point.hit, -ray.d);
      if (sample_lights_ && !selector_.empty())
        result.radiance += throughput * light_from_sample(world, point.hit, local, lambda, stream(Use::light_bsdf),
                                                          hash_key(vertex_key, uint64_t(Use::shadow_ray)), context);

      SampledSpectrum weight;
      const float uc = context.sampler.get1d();
      const Vec2 u = context.sampler.get2d();
      const auto sample = local.sample(uc, u, stream(Use::bsdf), weight, scatter_pdf);
      if (!sample) return result;
      throughput *= weight;
      lambda.retire_black_lanes(throughput);
      if (!sample_lights_ || any(sample->flags & Lobes::specular)) scatter_pdf = INFINITY;
      if (ends(throughput, lambda, depth, stream(Use::roulette), throughput)) return result;
      previous = point.hit.p;
      ray = {offset_origin(point.hit, sample->wi), sample->wi};
    }
  }

 private:
  static float distance_between(const Vec3& a, const Vec3& b) { return length(b - a); }

  /// Weight of light met by a scattered ray.
  float weight_of(const Light& light, float scatter_pdf, float light_pdf) const {
    if (std::isinf(scatter_pdf)) return 1;
    return power_heuristic(scatter_pdf, light_pdf * selector_.probability(light));
  }

  SampledSpectrum light_from_sample(const World& world, const Hit& hit, const LocalBsdf& bsdf,
                                    const SampledWavelengths& lambda, RandomStream rng, uint64_t shadow_key,
                                    PathContext& context) const {
    // Numbers that no light of the scene would read are not made; which are made is the same for every sample.
    const float choice = selector_.has_choice() ? context.sampler.get1d() : 0;
    const Vec2 u = selector_.has_extent() ? context.sampler.get2d() : Vec2{};
    const auto [light, probability] = selector_.choose(choice);
    const auto sample = light->sample(hit.p, u, lambda);
    if (!sample || sample->radiance.is_black()) return {};
    float scatter_pdf = 0;
    const SampledSpectrum f_cos = bsdf.f_cos(sample->wi, rng, scatter_pdf);
    if (f_cos.is_black()) return {};
    const Vec3 origin = offset_origin(hit, sample->wi);
    // Just short of the light's own surface.
    const float reach = std::isinf(sample->distance) ? sample->distance : sample->distance * (1 - 0x1p-13f);
    ++context.rays;
    if (world.occluded({origin, sample->wi, reach}, shadow_key)) return {};
    const float light_pdf = sample->pdf * probability;
    const float weight = light->is_delta() ? 1 : power_heuristic(light_pdf, scatter_pdf);
    return f_cos * sample->radiance * (weight / light_pdf);
  }

  /// Whether the path ends here; roulette rewards the survivors.
  bool ends(const SampledSpectrum& throughput, const SampledWavelengths& lambda, int depth, RandomStream rng,
            SampledSpectrum& rewarded) const {
    if (throughput.is_black()) return true;
    if (cut_off_attenuation_) return attenuation(throughput, lambda) < cutoff_;
    const float survival = throughput.max();
    if (depth < 2 || survival >= 1) return false;
    if (rng.uniform() >= survival) return true;
    rewarded *= 1 / survival;
    return false;
  }

  /// The paper's luminance of the attenuation, eq. 4, where the lanes are its three wavelengths; the mean elsewhere.
  static float attenuation(const SampledSpectrum& throughput, const SampledWavelengths& lambda) {
    if (lambda.count == 3) return 0.21222f * throughput[0] + 0.7013f * throughput[1] + 0.0865f * throughput[2];
    return mean(throughput, lambda);
  }

  int max_depth_;
  bool sample_lights_, select_by_power_, cut_off_attenuation_;
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
