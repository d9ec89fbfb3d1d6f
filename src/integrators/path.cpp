#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/fluorescence.h"
#include "integrators/fluorescence_tracer.h"
#include "integrators/path_parts.h"
#include "integrators/path_pilots.h"
#include "integrators/path_tracer.h"
#include "integrators/vertex_numbers.h"

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
     .range = {0, kMostSplit},
     .doc = "Light samples at the first hit; later hits have one. 0: one or two, whichever has less noise in the same "
            "time, by a pilot; always one where all lights are points or directions."},
    {.name = "scatteredrays",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, kMostSplit},
     .doc =
         "Rays that the first hit scatters where its surface is not a mirror; later hits scatter one. 0: one or two by "
         "material, whichever has less noise in the same time, by a pilot."},
    {.name = "roulette",
     .kind = ParamKind::real,
     .default_value = 0,
     .range = {0, 1e6},
     .doc =
         "Where termination is roulette: a path survives a scattering with the probability roulette x throughput; each "
         "of two rays has half of the throughput. 0: by the pilot, for the least noise in the same time; without a "
         "pilot 2, after the fifth scattering."},
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
     .doc = "Where termination is attenuation: the attenuation below which a path ends."},
    kRegularize,
    kHideBackground,
};

/// Unidirectional path tracing; light sampling and BSDF sampling combined by the power heuristic.
class PathIntegrator final : public Integrator, public FluorescenceIntegrator, public SubsurfaceIntegrator {
 public:
  explicit PathIntegrator(const Params& p)
      : settings_{.max_depth = p.integer("maxdepth"),
                  .sample_lights = p.boolean("sampledirect"),
                  .light_samples = std::max(1, p.integer("lightsamples")),
                  .scattered_rays = std::max(1, p.integer("scatteredrays")),
                  .cut_off_attenuation = p.string("termination") == "attenuation",
                  .cutoff = float(p.real("cutoff")),
                  .roulette = {},
                  .regularizes = p.boolean("regularize"),
                  .hides_background = p.boolean("hidebackground"),
                  .rays_by_material = {},
                  .subsurface = {}},
        adapted_{.light_samples = p.integer("lightsamples") == 0,
                 .scattered_rays = p.integer("scatteredrays") == 0,
                 .roulette = p.real("roulette") == 0 && !settings_.cut_off_attenuation},
        strategy_(light_strategy(p)) {
    if (const double scale = p.real("roulette"); scale > 0) settings_.roulette = {.scale = float(scale), .mean = 0};
    const auto warn_unused = [&p](std::string_view name, std::string_view needed) {
      if (p.given(name)) p.warn(name, fmt::format("\"{}\" has no effect without \"termination\" \"{}\"", name, needed));
    };
    settings_.cut_off_attenuation ? warn_unused("roulette", "roulette") : warn_unused("cutoff", "attenuation");
  }

  void set_fluorescence(std::vector<std::shared_ptr<const Fluorescence>> by_material) override {
    fluorescence_ = std::move(by_material);
  }

  void set_subsurface(SubsurfaceMaterials by_material) override { settings_.subsurface = std::move(by_material); }

  void prepare(const World& world) override {
    selector_ = LightSelector(world, strategy_);
    if (!fluorescence_.empty()) emitting_.emplace(fluorescence_, world);
  }

  std::string adapt(const World& world, const CameraSampling& sampling) override {
    const auto bands = world.wavelengths().bands();
    if (std::ranges::all_of(bands, is_of_fluorescence) && !bands.empty()) return {};  // no reflected light
    AdaptedSettings adapted = adapted_;
    adapted.light_samples = adapted.light_samples && settings_.sample_lights && selector_.has_extent();
    if (!adapted.light_samples && !adapted.scattered_rays) return {};
    try {
      adapt_to_scene(world, selector_, adapted, sampling, settings_);
    } catch (const SurfaceError&) {
      // The render throws it again, and its caller names the material.
    }
    return summary();
  }

  std::unique_ptr<Tracer> tracer(const World& world) const override {
    auto tracer = make_path_tracer(world, selector_, settings_);
    if (!emitting_) return tracer;
    return make_fluorescence_tracer(world, selector_, settings_, *emitting_, std::move(tracer));
  }

 private:
  /// Numbers of samples at first hits that are two; empty if all are one.
  std::string summary() const {
    std::vector<std::string> two;
    if (const auto count = std::ranges::count(settings_.rays_by_material, 2); count > 0)
      two.push_back(fmt::format("two scattered rays on {} material{}", count, count == 1 ? "" : "s"));
    if (settings_.light_samples == 2) two.emplace_back("two light samples");
    return two.empty() ? "" : fmt::format("path: at first hits {}", fmt::join(two, ", "));
  }

  PathSettings settings_;
  AdaptedSettings adapted_;
  LightSelector::Strategy strategy_;
  LightSelector selector_;
  std::vector<std::shared_ptr<const Fluorescence>> fluorescence_;  ///< by material; empty: no band is of fluorescence
  std::optional<EmittingMaterials> emitting_;
};

std::unique_ptr<Integrator> make_path(const Params& p) { return std::make_unique<PathIntegrator>(p); }

}  // namespace

extern const IntegratorInfo path_integrator{
    {"integrator", "path", "Path tracing with light sampling and multiple importance sampling.",
     "Kajiya 1986; Veach and Guibas 1995", kPath},
    make_path,
    true};

}  // namespace frond
