#include <fmt/format.h>

#include <algorithm>

#include "scene/format/plugin_text.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

// Wavelength strategy of a scene: the text of its option, and what the film adds.

namespace frond {
namespace {

constexpr std::string_view kSpectral = "spectral", kUniform = "uniform";

/// Returns the film's parameters that are the strategy's: the sensor, which weights wavelengths instead of the eye's
/// response, and the range of film "spectral", whose buckets need wavelengths of even density.
std::vector<ParsedParam> film_params(const SceneSettings& description) {
  using Values = decltype(ParsedParam::values);
  const ParsedPlugin& film = description.film;
  std::vector<ParsedParam> params;
  for (const ParsedParam& p : film.params)
    if ((p.name == "sensor" && p.values != Values(std::vector<std::string>{"cie1931"})) ||
        (p.name == "whitebalance" && p.values != Values(std::vector<double>{0})) ||
        (film.name == kSpectral && (p.name == "lambdamin" || p.name == "lambdamax")))
      params.push_back(p);
  if (film.name == kSpectral)
    params.push_back({"bool", std::string(kUniform), film.where, film.where, std::vector<bool>{true}});
  return params;
}

}  // namespace

/// Parses the parameters with the types of their declaration.
ParsedPlugin wavelengths_plugin(const SceneSettings& description, const Registry& registry) {
  const SceneOptions options = read_options(description);
  const Location& where = options.wavelengths_where;
  const PluginText choice = parse_plugin_text(options.wavelengths, where);
  ParsedPlugin plugin{choice.name, where, {}};
  set_params(choice, registry.wavelengths.get(choice.name, where), where, plugin);
  return plugin;
}

/// Parameters that the user gave take precedence over the film's.
std::unique_ptr<WavelengthStrategy> make_wavelengths(const SceneSettings& description, const Registry& registry,
                                                     const Log& log) {
  OptionResolver resolver(description);
  ParsedPlugin plugin = wavelengths_plugin(description, registry);
  const WavelengthsInfo& info = registry.wavelengths.get(plugin.name, plugin.where);
  const bool takes_buckets = find_param(info, kUniform);
  for (const ParsedParam& p : film_params(description)) {
    const bool is_of_buckets = p.name == kUniform || p.name.starts_with("lambda");
    if (is_of_buckets && !takes_buckets) continue;  // fit_buckets warns
    if (!find_param(info, p.name))
      log.warn(p.where, fmt::format("\"{}\" has no effect on wavelengths \"{}\"", p.name, info.name));
    else if (!find_param(plugin.params, p.name))
      plugin.params.push_back(p);
  }
  return make_checked(info, plugin.where, [&] { return info.make(Params(info, plugin, resolver)); });
}

/// Buckets without samples would be black: other strategies leave them out, and wavelengths that do not reach them are
/// an error.
void fit_buckets(const SceneSettings& description, const Registry& registry, FilmSettings& film, const Log& log) {
  if (film.buckets == 0) return;
  const auto strategy = make_wavelengths(description, registry);
  const ParsedPlugin plugin = wavelengths_plugin(description, registry);
  const auto [min, max] = film.buckets_nm;
  if (description.film.name != kSpectral ||
      !find_param(registry.wavelengths.get(plugin.name, plugin.where), kUniform)) {
    film.buckets = 0;
    log.warn(description.film.where,
             fmt::format("the spectral channels of Film \"{}\" are left out: wavelengths \"{}\" do not cover them",
                         description.film.name, plugin.name));
  } else if (const Interval nm = strategy->range_nm(); nm.min > min || nm.max < max) {
    fail(description.film.where, "the film's channels reach from {:g} to {:g} nm, the wavelengths from {:g} to {:g} nm",
         min, max, nm.min, nm.max);
  }
}

}  // namespace frond
