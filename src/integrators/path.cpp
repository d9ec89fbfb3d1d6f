#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "integrators/path_parts.h"
#include "integrators/path_pilots.h"
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
            "time, by a pilot; always one where all lights are points or directions."},
    {.name = "scatteredrays",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2},
     .doc = "Rays that the first hit scatters where its surface is not a mirror; later hits scatter one. 0: two on "
            "materials that reflect and transmit light and return at least 3/4 of it, and, if the scene has no light "
            "to sample (a uniform sky), on all others too if that has less noise in the same time, by a pilot."},
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
  std::string adapt(const World& world, const PilotRays& rays) override {
    try {
      adapt_scattered_rays(world, rays);
      adapt_light_samples(world, rays);
    } catch (const SurfaceError&) {
      // The render throws it again, and its caller names the material.
    }
    return summary();
  }

  std::unique_ptr<Tracer> tracer(const World& world) const override {
    return make_path_tracer(world, selector_, settings_);
  }

 private:
  void adapt_scattered_rays(const World& world, const PilotRays& rays) {
    if (settings_.scattered_rays != 0) return;
    if (selector_.empty() && two_rays_pay(world, selector_, settings_, rays))
      settings_.scattered_rays = 2;
    else
      settings_.bright = bright_materials(world, rays);
  }

  void adapt_light_samples(const World& world, const PilotRays& rays) {
    if (settings_.light_samples != 0) return;
    settings_.light_samples = 1;
    if (!settings_.sample_lights || !selector_.has_extent()) return;
    if (two_light_samples_pay(world, selector_, settings_, rays)) settings_.light_samples = 2;
  }

  /// What first hits take two of; empty if nothing.
  std::string summary() const {
    std::vector<std::string> two;
    const auto bright = std::ranges::count(settings_.bright, true);
    if (settings_.scattered_rays == 2) two.emplace_back("two scattered rays");
    if (bright > 0)
      two.push_back(fmt::format("two scattered rays on {} bright material{}", bright, bright == 1 ? "" : "s"));
    if (settings_.light_samples == 2 && selector_.has_extent()) two.emplace_back("two light samples");
    return two.empty() ? "" : fmt::format("path: at first hits {}", fmt::join(two, ", "));
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
