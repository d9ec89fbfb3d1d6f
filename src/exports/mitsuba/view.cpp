#include "exports/mitsuba/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exports/mitsuba/shapes.h"
#include "scene/format/plugin_text.h"

namespace frond::mitsuba {
namespace {

/// Part of the camera's plane z = 1, before the scaling by the field of view, that the film covers.
struct Window {
  double x0, x1, y0, y1;
  double half_width() const { return (x1 - x0) / 2; }
  double half_height() const { return (y1 - y0) / 2; }
};

/// As frond's cameras: the shorter axis spans -1 to 1 unless the scene states a window.
Window window_of(const Params& p, const FilmSettings& film) {
  const double aspect = p.given("frameaspectratio") ? p.real("frameaspectratio") : double(film.width) / film.height;
  const auto given = p.reals("screenwindow");
  if (given.size() == 4) return {given[0], given[1], given[2], given[3]};
  return aspect > 1 ? Window{-aspect, aspect, -1, 1} : Window{-1, 1, -1 / aspect, 1 / aspect};
}

/// Length of the camera's x axis in the world, which its lens and its parallel rays are scaled by. A transform that is
/// not a rotation with a scaling is reported.
double scale_of(Context& context, const AffineMap& world_from_camera, const Location& where) {
  if (const auto square = world_from_camera.area_scale()) return std::sqrt(double(*square));
  context.report_unsupported("cameras", where, "a camera transform that stretches has no equivalent in Mitsuba",
                             "the image is stretched differently");
  return double(length(world_from_camera.vector({1, 0, 0})));
}

/// Returns why Mitsuba has no such pixel filter; empty if it has.
std::string unsupported_filter_reason(const ParsedPlugin& filter, const Params& p) {
  const double x = p.real("xradius"), y = p.real("yradius");
  const auto none = [&](std::string_view has) {
    return fmt::format("filter \"{}\" with radii {:g} and {:g} has no equivalent in Mitsuba: {}", filter.name, x, y,
                       has);
  };
  const std::string& name = filter.name;
  if (x != y) return none("one radius has");
  if (name == "box") return x == 0.5 ? "" : none("0.5 has");
  if (name == "mitchell") return x == 2 ? "" : none("2 has");
  if (name == "sinc")
    return x == p.real("tau") && x == std::floor(x) ? "" : none("a whole radius equal to \"tau\" has");
  if (name == "triangle" || name == "gaussian") return "";
  return fmt::format("filter \"{}\" has no equivalent in Mitsuba", name);
}

/// Film, filter and sampler, as parts of the open sensor.
void write_film(Context& context, Xml& xml, const FilmSettings& film, int samples) {
  const ParsedPlugin& filter = context.description.filter;
  const Params p(context.registry.filters.get(filter.name, filter.where), filter, context.resolver);
  const double x = p.real("xradius");
  {
    const std::string& name = context.description.sampler.name;
    const Element sampler(xml, "sampler", {{"type", name == "independent" ? name : "multijitter"}});
    xml.integer("sample_count", samples);
  }
  const Element element(xml, "film", {{"type", "hdrfilm"}});
  xml.integer("width", film.width);
  xml.integer("height", film.height);
  if (film.crop != Crop{0, 0, film.width, film.height}) {
    xml.integer("crop_offset_x", film.crop.x0);
    xml.integer("crop_offset_y", film.crop.y0);
    xml.integer("crop_width", film.crop.width());
    xml.integer("crop_height", film.crop.height());
  }
  xml.text("pixel_format", context.spectra.variants() == Variants::mono ? "luminance" : "rgb");
  xml.text("component_format", "float32");
  // Samples beyond the border contribute to its pixels, as in frond.
  if (filter.name != "box") xml.flag("sample_border", true);
  if (const std::string why = unsupported_filter_reason(filter, p); !why.empty()) {
    context.report_unsupported("films", filter.where, why, "a box filter of one pixel stands for it");
    xml.element("rfilter", {{"type", "box"}});
  } else if (filter.name == "box") {
    xml.element("rfilter", {{"type", "box"}});
  } else if (filter.name == "triangle") {
    const Element tent(xml, "rfilter", {{"type", "tent"}});
    xml.number("radius", x);
  } else if (filter.name == "gaussian") {
    const double sigma = p.real("sigma");
    if (std::abs(x - 4 * sigma) > 1e-6)
      context.warn(filter.where, fmt::format("Mitsuba's gaussian filter has a radius of 4 sigma, {:g} pixels, instead "
                                             "of {:g}",
                                             4 * sigma, x));
    const Element gaussian(xml, "rfilter", {{"type", "gaussian"}});
    xml.number("stddev", sigma);
  } else if (filter.name == "mitchell") {
    const Element mitchell(xml, "rfilter", {{"type", "mitchell"}});
    xml.number("A", p.real("B"));
    xml.number("B", p.real("C"));
  } else {
    const Element lanczos(xml, "rfilter", {{"type", "lanczos"}});
    xml.integer("lobes", int(x));
  }
  if (std::isfinite(film.max_component))
    context.warn(context.description.film.where,
                 "\"maxcomponentvalue\" has no equivalent in Mitsuba: nothing is clamped");
}

/// Mitsuba's camera space has x to the left, frond's to the right of the image. A mirrored window mirrors the image.
Transform::RowsDouble mirrored_x(Transform::RowsDouble rows, double x, double y) {
  for (auto& row : rows) row[0] *= -x, row[1] *= y;
  return rows;
}

/// Cameras are written with their distance in Mitsuba's units; the field of view does not depend on them.
void write_sensor(Context& context, Xml& xml, const FilmSettings& film, int samples) {
  ParsedPlugin camera = context.description.camera;
  if (camera.name != "perspective" && camera.name != "orthographic") {
    context.report_unsupported(
        "cameras", camera.where,
        fmt::format("camera \"{}\" has no equivalent in Mitsuba: perspective and orthographic have", camera.name),
        "a perspective camera of 90 degrees at its place stands for it");
    camera.name = "perspective", camera.params.clear();
  }
  const bool is_perspective = camera.name == "perspective";
  if (context.description.camera_from_world.moves())
    context.report_unsupported("cameras", camera.where, "a camera that moves has no equivalent in Mitsuba",
                               "it stands where it is when the shutter opens");
  const Params p(context.registry.cameras.get(camera.name, camera.where), camera, context.resolver);
  const Window window = window_of(p, film);
  const double aspect = double(film.width) / film.height;
  const AffineMap map{context.description.camera_from_world.start.inverse().rows()};
  const double scale = scale_of(context, map, camera.where), units = context.units;
  double lens = p.real("lensradius");
  Transform::RowsDouble rows = rows_of(map);
  if (is_perspective) {
    if (std::abs(std::abs(window.half_width() / window.half_height()) / aspect - 1) > 1e-6)
      context.report_unsupported("cameras", camera.where, "pixels that are not square have no equivalent in Mitsuba",
                                 "they are square: the image shows more or less of the scene along y");
    for (auto& row : rows)
      for (size_t j = 0; j < 3; ++j) row[j] /= scale;  // a perspective does not depend on the scale
    rows = mirrored_x(rows, std::copysign(1.0, window.half_width()), std::copysign(1.0, window.half_height()));
  } else {
    if (lens > 0) {
      context.report_unsupported("cameras", p.where("lensradius"),
                                 "an orthographic camera with a lens has no equivalent in Mitsuba",
                                 "everything is in focus");
      lens = 0;
    }
    // Mitsuba's film spans -1 to 1 along x.
    for (auto& row : rows) row[3] += row[0] * (window.x0 + window.x1) / 2 + row[1] * (window.y0 + window.y1) / 2;
    rows = mirrored_x(rows, window.half_width(), window.half_height() * aspect);
    for (auto& row : rows)
      for (size_t j = 0; j < 3; ++j) row[j] *= units;
  }
  for (auto& row : rows) row[3] *= units;
  const Element sensor(xml, "sensor",
                       {{"type", !is_perspective ? "orthographic"
                                 : lens > 0      ? "thinlens"
                                                 : "perspective"}});
  if (is_perspective) {
    const double tangent = std::tan(p.real("fov") * std::numbers::pi / 360);
    xml.number("fov", std::atan(tangent * std::abs(window.half_width())) * 360 / std::numbers::pi);
    xml.text("fov_axis", "x");
    // As shares of the film's width and height.
    const double x = (window.x0 + window.x1) / (2 * (window.x1 - window.x0)),
                 y = (window.y0 + window.y1) / (2 * (window.y1 - window.y0));
    if (x != 0) xml.number("principal_point_offset_x", x);
    if (y != 0) xml.number("principal_point_offset_y", -y);
    if (lens > 0) {
      xml.number("aperture_radius", lens * scale * units);
      xml.number("focus_distance", p.real("focaldistance") * scale * units);
    }
  }
  // frond has no clipping planes.
  xml.number("near_clip", is_perspective ? 1e-3 * units : 1e-6);
  xml.number("far_clip", is_perspective ? 1e6 * units : 1e6);
  xml.matrix("to_world", rows);
  write_film(context, xml, film, samples);
}

/// True if a shape states its opacity.
bool has_alpha(const SceneDescription& description) {
  const auto states_it = [](const std::vector<ShapeDescription>& shapes) {
    return std::ranges::any_of(
        shapes, [](const ShapeDescription& shape) { return find_param(shape.plugin.params, "alpha") != nullptr; });
  };
  return states_it(description.shapes) ||
         std::ranges::any_of(description.objects, [&](const auto& object) { return states_it(object.shapes); });
}

}  // namespace

/// Mitsuba counts path segments, frond scattering events.
void write_view(Context& context, Xml& xml, const FilmSettings& film, int samples) {
  const ParsedPlugin& integrator = context.description.integrator;
  const Params p(context.registry.integrators.get(integrator.name, integrator.where), integrator, context.resolver);
  const bool is_path = integrator.name == "path";
  if (!is_path)
    context.report_unsupported("integrators", integrator.where,
                               fmt::format("integrator \"{}\" is not exported: path is", integrator.name),
                               "path stands for it");
  if (is_path && p.string("termination") != "roulette")
    context.warn(p.where("termination"), "paths end by Russian roulette in Mitsuba, without bias");
  {
    // Shadow rays of Mitsuba's path tracer are blocked by masks; shadow rays of its volumetric path tracer are not.
    const Element path(xml, "integrator", {{"type", has_alpha(context.description) ? "volpath" : "path"}});
    xml.integer("max_depth", p.integer("maxdepth") + 1);
    if (p.boolean("hidebackground")) {
      xml.flag("hide_emitters", true);
      context.warn(p.where("hidebackground"), "Mitsuba hides area lights from the camera too");
    }
  }
  write_sensor(context, xml, film, samples);
}

}  // namespace frond::mitsuba
