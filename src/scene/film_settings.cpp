#include <cmath>

#include "scene/cameras/films.h"
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
}

/// Returns the exposure time of a camera with a shutter, in s; 1 for other cameras.
double open_time(const Params& camera, const CameraInfo& info) {
  const auto is_time = [&info](std::string_view name) {
    const Param* declared = find_param(info, name);
    return declared && declared->kind == ParamKind::real;
  };
  if (!is_time("shutteropen") || !is_time("shutterclose")) return 1;
  return std::abs(camera.real("shutterclose") - camera.real("shutteropen"));
}

}  // namespace

/// The exposure time of the camera and the film speed become one factor.
FilmSettings Scene::film_settings(const SceneSettings& description, const Registry& registry, const Log& log) {
  OptionResolver resolver(description, log);
  const FilmInfo& info = registry.films.get(description.film.name, description.film.where);
  FilmSettings film =
      made_by(info, description.film.where, [&] { return info.make(Params(info, description.film, resolver)); });
  check_film(film, info, description.film.where);
  const CameraInfo& camera = registry.cameras.get(description.camera.name, description.camera.where);
  film.exposure *= open_time(Params(camera, description.camera, resolver), camera);
  return description.is_quick ? halved(film) : film;
}

}  // namespace frond
