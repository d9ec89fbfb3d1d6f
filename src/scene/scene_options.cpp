#include "scene/scene_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/plugin.h"
#include "scene/format/plugin_text.h"

namespace frond {
namespace {

constexpr std::string_view kCoordSystems[] = {"camera", "cameraworld", "world"};
constexpr Param kOptionParams[] = {
    {.name = "seed",
     .kind = ParamKind::integer,
     .default_value = 0,
     .range = {0, 2147483647},
     .doc = "Seed of all random numbers."},
    {.name = "wavelengths",
     .kind = ParamKind::string,
     .default_value = std::string_view("hero"),
     .doc = "Wavelength strategy: hero, meyer, smpte or bands, with parameters."},
    {.name = "period",
     .kind = ParamKind::real,
     .range = {1e-6, 1e9},
     .doc = "Two lengths along x and y after which the scene is repeated periodically.",
     .list = true},
    {.name = "disablepixeljitter",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Sample only the centres of pixels and lens."},
    {.name = "disabletexturefiltering",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Point-sample textures, without filtering."},
    {.name = "disablewavelengthjitter",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Use the same wavelengths for all samples."},
    {.name = "extendspectra",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Beyond the ends of their data, spectra keep their first and last values, with a warning."},
    {.name = "forcediffuse",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning."},
    {.name = "pixelstats",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning."},
    {.name = "wavefront",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning."},
    {.name = "displacementedgescale",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning."},
    {.name = "msereferenceimage",
     .kind = ParamKind::string,
     .default_value = std::string_view(),
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning. frond difference compares images."},
    {.name = "msereferenceout",
     .kind = ParamKind::string,
     .default_value = std::string_view(),
     .doc = "Accepted for compatibility with pbrt-v4; ignored with a warning. frond difference compares images."},
    {.name = "rendercoordsys",
     .kind = ParamKind::string,
     .default_value = std::string_view("cameraworld"),
     .doc = "Accepted for compatibility with pbrt-v4; ignored: the image does not depend on it.",
     .choices = kCoordSystems},
};
constexpr PluginInfo kOptions{"scene option", "Option", "Options of the whole render.", "", kOptionParams};

/// Throws InputError for an unknown option, with the nearest name.
void check_names(const std::vector<ParsedParam>& options) {
  std::vector<std::string_view> names;
  for (const Param& p : kOptionParams) names.push_back(p.name);
  for (const ParsedParam& p : options)
    if (std::ranges::find(names, p.name) == names.end())
      fail(p.where, "there is no option \"{}\"{}", p.name, suggestion(p.name, names));
}

}  // namespace

SceneOptions read_options(const SceneSettings& description, const Log& log) {
  check_names(description.options);
  OptionResolver resolver(description, log);
  const Params p(kOptions, {"Option", {}, description.options}, resolver);
  for (const std::string_view name : {"forcediffuse", "pixelstats", "wavefront"})
    if (p.boolean(name)) p.warn(name, fmt::format("option \"{}\" has no effect", name));
  for (const std::string_view name : {"displacementedgescale", "msereferenceimage", "msereferenceout"})
    if (p.given(name)) p.warn(name, fmt::format("option \"{}\" has no effect", name));
  SceneOptions options;
  if (p.given("seed")) options.seed = uint64_t(p.integer("seed"));
  if (description.seed) options.seed = description.seed;
  options.wavelengths = p.string("wavelengths"), options.wavelengths_where = p.where("wavelengths");
  if (p.given("period")) {
    const std::vector<double> period = p.reals("period");
    options.period_where = p.where("period");
    if (period.size() != 2) fail(options.period_where, "\"period\" takes 2 values, {} given", period.size());
    options.period = Vec2{float(period[0]), float(period[1])};
  }
  options.has_pixel_jitter = !p.boolean("disablepixeljitter");
  options.has_wavelength_jitter = !p.boolean("disablewavelengthjitter");
  options.filters_textures = !p.boolean("disabletexturefiltering");
  options.extends_spectra = p.boolean("extendspectra");
  return options;
}

/// Overrides the scene's own option.
void set_wavelengths(SceneSettings& description, const std::string& text, const Location& where) {
  set_param(description.options, {"string", "wavelengths", where, where, std::vector<std::string>{text}});
}

}  // namespace frond
