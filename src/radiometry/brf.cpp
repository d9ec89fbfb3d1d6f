#include "radiometry/brf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fluorescence.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/radiometer_scene.h"
#include "scene/format/plugin_text.h"
#include "scene/leaf_models.h"

namespace frond {
namespace {

/// Returns the azimuth of a view from +x. With one sun, azimuth 0 is the sun's plane, and negative zenith angles are on
/// the sun's side.
double absolute_azimuth_deg(const ViewDirection& view, const std::optional<Vec3>& sun) {
  if (!sun) return view.azimuth_deg;
  const double away = std::atan2(-double(sun->y), -double(sun->x)) * 180 / std::numbers::pi;
  return away + view.azimuth_deg;
}

/// Returns the numbers of cells along x and y that divide the target into kCells cells, as square as possible.
std::vector<double> cells_of(const Target& target) {
  double along_x = 1;
  while (along_x < BrfMeter::kCells &&
         (target.x1 - target.x0) / along_x > (target.y1 - target.y0) * 2 * along_x / BrfMeter::kCells)
    along_x *= 2;
  return {along_x, BrfMeter::kCells / along_x};
}

ParsedPlugin camera_of(const BrfRequest& request, const Target& target, const Scene& scene,
                       const std::optional<Vec3>& sun) {
  std::vector<double> zenith, azimuth;
  double distance = 0;
  for (const ViewDirection& view : request.views) {
    zenith.push_back(view.zenith_deg);
    azimuth.push_back(absolute_azimuth_deg(view, sun));
    const double cosine = std::cos(view.zenith_deg * std::numbers::pi / 180);
    if (cosine > 0) distance = std::max(distance, distance_above(scene, target, cosine));
  }
  return {"distant",
          {},
          {parsed_numbers("float", "zenith", zenith), parsed_numbers("float", "azimuth", azimuth),
           parsed_numbers("float", "target", {target.x0, target.x1, target.y0, target.y1, target.z}),
           parsed_numbers("integer", "strata", cells_of(target)), parsed_numbers("float", "distance", {distance})}};
}

std::string text_of(const std::vector<ViewDirection>& views) {
  std::string text = "brf";
  for (const ViewDirection& view : views) text += fmt::format(" {},{}", view.zenith_deg, view.azimuth_deg);
  return text;
}

/// Whether the scene has stochastic models that take the light's direction as incident: the weights of paths traced
/// from the sensor are then unbounded (docs/conventions.md).
bool has_heavy_tails(const Scene& scene, size_t materials) {
  const SampledWavelengths lambda = scene.wavelengths().sample(0.5f);
  const Hit hit{.p = {}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}, {}}};
  for (size_t place = 0; place < materials; ++place) {
    const Material* material = scene.material(place);
    if (!material) continue;
    Arena arena;
    const Bsdf* bsdf = material->evaluate(hit, lambda, arena);
    if (bsdf && any(bsdf->flags() & Lobes::stochastic) && any(bsdf->flags() & Lobes::from_light)) return true;
  }
  return false;
}

}  // namespace

double error_of_rows(std::span<const double> rows) {
  double squares = 0;
  for (size_t cell = 0; cell < BrfMeter::kCells; ++cell) squares += std::pow(rows[2 * cell] - rows[2 * cell + 1], 2);
  return std::sqrt(squares) / BrfMeter::kRows;
}

double BrfMeasurement::relative_error() const {
  double sum = 0;
  // At the ends of its wavelengths fluorescence is exactly 0.
  const bool may_be_dark = std::ranges::any_of(bands, is_of_fluorescence);
  for (const MeanError& v : values)
    if (v.mean > 0 || !may_be_dark) sum += std::pow(v.mean > 0 ? v.standard_error / v.mean : 1.0, 2);
  return values.empty() ? 0 : std::sqrt(sum / double(values.size()));
}

BrfMeter::BrfMeter(Session& session, SceneDescription description, const BrfRequest& request, const Scene* other)
    : request_(request) {
  prepare_for_radiometry(session.registry(), request.wavelengths, request.period, request.keeps_depth, description,
                         request.fluorescence);
  constexpr size_t kMostViews = 65536;  // of a film's columns
  if (request.views.size() > kMostViews)
    fail({}, "{} directions of view: {} is the limit", request.views.size(), kMostViews);
  const LoadedScene first = session.load(description, {}, other);
  const Scene& scene = first.scene();
  // The first of several scenes of one geometry has warned.
  const Target target = request.target ? *request.target : default_target(scene, other ? silent_log() : session.log());
  check_target(scene, target);
  const std::optional<Vec3> sun = direction_to_sun(scene.lights());
  if (sun) sun_zenith_deg_ = std::acos(std::clamp(double(sun->z), -1.0, 1.0)) * 180 / std::numbers::pi;
  description.camera = camera_of(request, target, scene, sun);
  description.camera_from_world = {};
  // The sensor is outside the scene, where no medium is.
  if (description.camera_medium && description.medium_interfaces.empty())
    fail({}, "the medium of the camera has no bound, so that no light comes from outside: bound it by a surface");
  description.camera_medium.reset();
  description.filter = {"box", {}, {}};
  description.film = {"rgb",
                      {},
                      {parsed_numbers("integer", "xresolution", {double(request.views.size())}),
                       parsed_numbers("integer", "yresolution", {double(kRows)})}};
  scene_ = session.load(std::move(description),
                        {.command = measurement_text(text_of(request.views), request.target, request.period)}, &scene);
  check_memory(scene_.film_format(), 1, {}, "measure fewer views or wavelengths at a time");
  has_heavy_tails_ = has_heavy_tails(scene, scene_.description().materials.size());
  if (has_heavy_tails_)
    session.log().warn(
        {},
        fmt::format("a leaf's random walk ({}) takes the light's direction for incident: its noise has no bound, and "
                    "what is printed as standard error is too small; {} is the same leaf without noise",
                    reference_model(session.registry()).name, noiseless_model(session.registry()).name));
  const HorizontalIrradiance irradiance(scene_);
  for (const double e : irradiance.bands()) white_.push_back(request.fluorescence ? 1 : e / std::numbers::pi);
  size_t beams = 0;
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    if (irradiance.shares()[i] <= 0) continue;
    is_hemispherical_ = is_hemispherical_ || !scene.lights()[i]->is_delta() || beams > 0;
    ++beams;
  }
}

BrfMeasurement BrfMeter::read(const Film& film, bool with_rows) const {
  BrfMeasurement measurement{.views = request_.views, .bands = {}, .values = {}, .rows = {}};
  measurement.has_heavy_tails = has_heavy_tails_;
  if (is_hemispherical_) measurement.quantity = "HDRF";
  if (request_.fluorescence) measurement.quantity = "radiance";
  measurement.sun_zenith_deg = sun_zenith_deg_;
  const auto bands = scene_.scene().wavelengths().bands();
  measurement.bands.assign(bands.begin(), bands.end());
  for (int view = 0; view < film.settings().width; ++view)
    for (size_t band = 0; band < film.bands(); ++band) {
      double sum = 0;
      std::array<double, kRows> rows;
      for (int row = 0; row < kRows; ++row)
        sum += rows[size_t(row)] = film.band_mean(view, row, band).mean / white_[band];
      measurement.values.push_back({sum / kRows, error_of_rows(rows)});
      if (with_rows) measurement.rows.insert(measurement.rows.end(), rows.begin(), rows.end());
    }
  for (int row = 0; row < kRows; ++row) measurement.paths += film.samples(0, row);
  return measurement;
}

}  // namespace frond
