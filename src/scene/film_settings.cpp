#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cameras/films.h"
#include "scene/format/plugin_text.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

// Film settings of a scene.

namespace frond {
namespace {

/// Validates the settings, because a plug-in's film may return any values.
void check_film(const FilmSettings& film, const FilmInfo& info, const Location& where) {
  const auto [x0, y0, x1, y1] = film.crop;
  if (film.width < 1 || film.height < 1 || film.width > 65536 || film.height > 65536)
    fail(where, "film \"{}\" has {} x {} pixels: 1 to 65536 are possible", info.name, film.width, film.height);
  if (x0 < 0 || y0 < 0 || x1 > film.width || y1 > film.height || x0 >= x1 || y0 >= y1)
    fail(where, "film \"{}\" has a crop from ({}, {}) to ({}, {}), which holds no pixel of its {} x {} or lies outside",
         info.name, x0, y0, x1, y1, film.width, film.height);
  if (!(std::isfinite(film.exposure) && film.exposure >= 0 && film.max_component >= 0))
    fail(where, "film \"{}\" has the exposure {} and clamps at {}: neither can be below 0", info.name, film.exposure,
         film.max_component);
  if (film.buckets < 0 || (film.buckets > 0 && !(film.buckets_nm.min < film.buckets_nm.max)))
    fail(where, "film \"{}\" has {} spectral channels from {} to {} nm: the range is empty", info.name, film.buckets,
         film.buckets_nm.min, film.buckets_nm.max);
}

/// Returns the times at which a camera's shutter opens and closes, in s; 0 and 1 for cameras without one.
Interval shutter_times(const Params& camera, const CameraInfo& info) {
  const auto is_time = [&info](std::string_view name) {
    const Param* declared = find_param(info, name);
    return declared && declared->kind == ParamKind::real;
  };
  if (!is_time("shutteropen") || !is_time("shutterclose")) return {0, 1};
  const double open = camera.real("shutteropen"), close = camera.real("shutterclose");
  return {std::min(open, close), std::max(open, close)};
}

/// Warns of an open time that changes the brightness of the image by more than two stops, unless the film states the
/// exposure itself: other programs' scenes have short times for the blur of motion alone.
void warn_of_open_time(const SceneSettings& description, double seconds, const Log& log) {
  constexpr double kOfNote = 4;
  if (!(seconds > 0) || (seconds >= 1 / kOfNote && seconds <= kOfNote)) return;
  for (const ParsedParam& p : description.film.params)
    if (p.name == "iso" || p.name == "exposuretime") return;
  const double factor = seconds < 1 ? 1 / seconds : seconds;
  log.warn(
      description.camera.where,
      fmt::format("the shutter is open for {:.3g} s: the exposure (open time in s x iso / 100) is {:.3g}, and the "
                  "image {:.3g} times {} than with 1 s; \"float iso\" {:.4g} of the Film keeps the brightness, 100 "
                  "states that it is meant",
                  seconds, seconds, factor, seconds < 1 ? "darker" : "brighter", 100 / seconds));
}

Interval open_times(const SceneSettings& description, const Registry& registry, OptionResolver& resolver) {
  const CameraInfo& camera = registry.cameras.get(description.camera.name, description.camera.where);
  return shutter_times(Params(camera, description.camera, resolver), camera);
}

}  // namespace

Interval Scene::shutter(const SceneSettings& description, const Registry& registry, const Log& log) {
  OptionResolver resolver(description, log);
  const Interval open = open_times(description, registry, resolver);
  const auto& [start, end] = description.transform_times;
  return {(open.min - start) / (end - start), (open.max - start) / (end - start)};
}

/// The exposure time of the camera and the film speed become one factor.
FilmSettings Scene::film_settings(const SceneSettings& description, const Registry& registry, const Log& log) {
  OptionResolver resolver(description, log);
  const FilmInfo& info = registry.films.get(description.film.name, description.film.where);
  FilmSettings film =
      make_checked(info, description.film.where, [&] { return info.make(Params(info, description.film, resolver)); });
  check_film(film, info, description.film.where);
  fit_buckets(description, registry, film, log);
  const Interval open = open_times(description, registry, resolver);
  film.exposure *= open.max - open.min;
  warn_of_open_time(description, open.max - open.min, log);
  return description.is_quick ? halved(film) : film;
}

}  // namespace frond
