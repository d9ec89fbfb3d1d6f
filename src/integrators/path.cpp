#include <algorithm>
#include <cmath>

#include "integrators/path_parts.h"
#include "integrators/path_tracer.h"

namespace frond {
namespace {

constexpr std::string_view kTerminations[] = {"roulette", "attenuation"};
constexpr Param kPath[] = {
    {.name = "maxdepth",
     .kind = ParamKind::integer,
     .default_value = 5,
     .range = {0, 1 << 20},
     .doc = "Longest path, in scattering events."},
    {.name = "sampledirect",
     .kind = ParamKind::boolean,
     .default_value = true,
     .doc = "Sample lights at every hit; false: only scattered rays find lights."},
    {.name = "lightsamples",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2},
     .doc = "Light samples at the first hit; later hits have one. 0: one or two, whichever has less noise in the same "
            "time; a pilot decides."},
    {.name = "scatteredrays",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2},
     .doc = "Rays that the first hit scatters where its surface reflects and transmits light, other than as a mirror; "
            "later hits scatter one. 0: two if the material returns at least 3/4 of the light, else one; a pilot "
            "measures it."},
    {.name = "lightsampler",
     .kind = ParamKind::string,
     .default_value = std::string_view("bvh"),
     .doc = "Selection of a light at a hit. bvh: by a light tree's estimate of its contribution there.",
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
    kRegularize,
};

/// Noise and cost of paths. A sample of the noise is half the squared difference of the mean radiances of two bundles
/// of a pixel.
class PathPilot {
 public:
  PathPilot(const World& world, const LightSelector& selector, const PathSettings& settings)
      : settings_(settings), tracer_(make_path_tracer(world, selector, settings_)) {}

  void add(PathBundle a, PathBundle b) {
    const double difference = radiance(a) - radiance(b);
    if (std::isfinite(difference)) variance_ += difference * difference / 2;
  }
  double variance() const { return variance_; }  ///< sum over the pairs
  uint64_t rays() const { return rays_; }

 private:
  double radiance(PathBundle& bundle) {
    tracer_->trace(bundle);
    rays_ += bundle.traced;
    double sum = 0;
    for (size_t i = 0; i < bundle.results.size(); ++i)
      sum += double(mean(bundle.results[i].radiance, bundle.lambda[i]));
    return sum / double(bundle.results.size());
  }

  PathSettings settings_;
  std::unique_ptr<Tracer> tracer_;
  double variance_ = 0;
  uint64_t rays_ = 0;
};

/// The same camera rays, followed by other random numbers.
PathBundle with_other_numbers(PathBundle bundle) {
  constexpr uint32_t kFar = 1 << 20;  // beyond the dimensions of any path
  bundle.dimension += kFar;
  for (uint64_t& key : bundle.keys) key = hash_key(key, kFar);
  return bundle;
}

/// Estimates the albedo of the material at `point`, where a camera ray of the bundle meets it; empty if it does not
/// reflect and transmit light.
std::optional<double> two_sided_albedo(const SurfacePoint& point, const PathBundle& bundle, size_t ray, Arena& arena) {
  const SampledWavelengths& lambda = bundle.lambda[ray];
  arena.reset();
  const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, arena);
  if (!bsdf || !has_two_sides(*bsdf)) return {};
  LocalBsdf local;
  local.set(*bsdf, point.hit, -bundle.rays[ray].d);
  return double(mean(local.albedo(1, bundle.keys[ray]), lambda));
}

/// Materials, by id, that reflect and transmit light and return most of it, where camera rays meet them.
std::vector<bool> bright_materials(const World& world, const PilotRays& rays) {
  constexpr uint64_t kPixels = 256;
  constexpr size_t kStep = 4;  // every fourth camera ray
  constexpr double kMost = 0.75;
  std::vector<double> excess;  // by material: sum of albedos less kMost
  std::vector<bool> is_met;
  Arena arena;
  SurfacePoint point;
  const SurfacePoint* const at = &point;
  for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
    check_stop();
    const PathBundle bundle = rays.bundle(pixel, 0);
    for (size_t i = 0; i < bundle.rays.size(); i += kStep) {
      if (!world.intersect(bundle.rays[i], bundle.keys[i], point)) continue;
      std::optional<double> albedo;
      with_surface_of_errors(at, [&] { albedo = two_sided_albedo(point, bundle, i, arena); });
      if (!albedo) continue;
      if (excess.size() <= point.material_id) excess.resize(point.material_id + 1), is_met.resize(excess.size());
      excess[point.material_id] += *albedo - kMost;
      is_met[point.material_id] = true;
    }
  }
  for (size_t i = 0; i < excess.size(); ++i) is_met[i] = is_met[i] && excess[i] >= 0;
  return is_met;
}

/// Whether two light samples at the first hit have less variance times CPU time than one. What they save is the
/// variance of direct light for given camera rays: that of whole pixels would show it as well, with more noise.
bool two_samples_pay(const World& world, const LightSelector& selector, PathSettings settings, const PilotRays& rays) {
  constexpr uint64_t kPixels = 256;
  settings.light_samples = 2;
  PathPilot whole(world, selector, settings);
  settings.max_depth = std::min(settings.max_depth, 1);
  PathPilot two(world, selector, settings);
  settings.light_samples = 1;
  PathPilot one(world, selector, settings);
  for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
    check_stop();
    const PathBundle bundle = rays.bundle(pixel, 0), other = with_other_numbers(bundle);
    whole.add(bundle, rays.bundle(pixel, 1));
    two.add(bundle, other);
    one.add(bundle, other);
  }
  // Measured, a light sample with its ray adds 0.5 to 0.8 of the time that the rest of a path takes for each of its
  // rays.
  constexpr double kTime = 2. / 3;
  const double second = double(two.rays()) - double(one.rays()), rest = double(whole.rays()) - second;
  return rest > 0 && one.variance() - two.variance() > whole.variance() * kTime * second / rest;
}

/// Unidirectional path tracing; light sampling and BSDF sampling combined by the power heuristic.
class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const Params& p)
      : settings_{.max_depth = p.integer("maxdepth"),
                  .sample_lights = p.boolean("sampledirect"),
                  .light_samples = p.integer("lightsamples"),
                  .scattered_rays = p.integer("scatteredrays"),
                  .cut_off_attenuation = p.string("termination") == "attenuation",
                  .cutoff = float(p.real("cutoff")),
                  .regularizes = p.boolean("regularize"),
                  .bright = {}},
        strategy_(light_strategy(p)) {}

  void prepare(const World& world) override { selector_ = LightSelector(world, strategy_); }

  /// Selects the numbers of scattered rays and of light samples at the first vertex.
  void adapt(const World& world, const PilotRays& rays) override {
    try {
      if (settings_.scattered_rays == 0) settings_.bright = bright_materials(world, rays);
      adapt_light_samples(world, rays);
    } catch (const SurfaceError&) {
      // The render throws it again, and its caller names the material.
    }
  }

  std::unique_ptr<Tracer> tracer(const World& world) const override {
    return make_path_tracer(world, selector_, settings_);
  }

 private:
  void adapt_light_samples(const World& world, const PilotRays& rays) {
    if (settings_.light_samples != 0) return;
    settings_.light_samples = 1;
    if (!settings_.sample_lights || !selector_.has_extent()) return;
    if (two_samples_pay(world, selector_, settings_, rays)) settings_.light_samples = 2;
  }

  PathSettings settings_;
  LightSelector::Strategy strategy_;
  LightSelector selector_;
};

std::unique_ptr<Integrator> make_path(const Params& p) { return std::make_unique<PathIntegrator>(p); }

}  // namespace

extern const IntegratorInfo path_integrator{
    {"integrator", "path", "Path tracing with light sampling and multiple importance sampling.",
     "Kajiya 1986; Veach and Guibas 1995", kPath},
    make_path};

}  // namespace frond
