#include "exports/mitsuba/lights.h"

#include <algorithm>
#include <cmath>

#include "core/light.h"
#include "exports/mitsuba/environment.h"
#include "image/image_file.h"
#include "scene/format/plugin_text.h"

namespace frond::mitsuba {
namespace {

/// Texels along a side of a square image of a sky, which is smooth but for its aureole.
constexpr int kSkyTexels = 32;

/// Values of a light at a point or in a direction, in Mitsuba's unit.
template <class At>
std::vector<double> emitted(const Context& context, double scale, const At& at) {
  return context.spectra.emission(context.spectra.values(at), scale * context.exposure);
}

/// Intensity of a light at a point, from the light that arrives at unit distance along `axis`.
std::vector<double> intensity(const Context& context, const Light& light, const Vec3& position, const Vec3& axis) {
  const double square = context.units * context.units;
  return emitted(context, square, [&](const SampledWavelengths& lambda) {
    const auto sample = light.sample(position + axis, {0.5f, 0.5f}, lambda);
    return sample ? sample->radiance * (sample->distance * sample->distance) : SampledSpectrum();
  });
}

/// The axis of Mitsuba's spot is +z of its transform.
void write_spot(Context& context, Xml& xml, const Light& light, const Params& p, const ParsedPlugin& plugin) {
  const LightBounds at = *light.bounds();
  const double cone = p.real("coneangle"), delta = p.real("conedeltaangle");
  if (delta > 0)
    context.warn(plugin.where, "the edge of a spot light differs: Mitsuba's is linear in the angle, frond's is smooth");
  const Element emitter(xml, "emitter", {{"type", "spot"}});
  context.spectra.write(xml, "intensity", intensity(context, light, at.min, at.axis));
  xml.number("cutoff_angle", cone);
  // Mitsuba divides by the difference of both angles.
  xml.number("beam_width", std::min(cone - delta, cone * (1 - 1e-5)));
  const Frame frame = Frame::around(at.axis);
  const auto units = context.units;
  xml.matrix("to_world", {{{double(frame.x.x), double(frame.y.x), double(frame.z.x), double(at.min.x) * units},
                           {double(frame.x.y), double(frame.y.y), double(frame.z.y), double(at.min.y) * units},
                           {double(frame.x.z), double(frame.y.z), double(frame.z.z), double(at.min.z) * units}}});
}

/// Makes a light that surrounds the scene, and adds it to those that are written together.
void add_surroundings(Context& context, const LightDescription& description, std::vector<Surroundings>& all) {
  ParsedPlugin plugin = description.plugin;
  const LightInfo& info = context.registry.lights.get(plugin.name, plugin.where);
  if (plugin.name == "sky" &&
      !context.report_unsupported(
          "lights", plugin.where, "light \"sky\" has no equivalent in Mitsuba",
          "its sun becomes parallel light, which has no half-shadows and is not seen in mirrors, and its sky "
          "an image"))
    return;
  if (const ParsedParam* const portal = find_param(plugin.params, "portal")) {
    context.report_unsupported("lights", portal->where, "a light with a portal has no equivalent in Mitsuba",
                               "the portal is left out: the light enters from everywhere");
    std::erase_if(plugin.params, [](const ParsedParam& p) { return p.name == "portal"; });
  }
  const Params p(info, plugin, context.resolver);
  Surroundings made{description,
                    make_checked(info, plugin.where, [&] { return info.make(p, description.world_from_light); })};
  if (const auto* const file = find_param(plugin.params, "filename"))
    made.texels = read_image(p.file("filename"), file->where).image.width;
  else if (plugin.name == "sky")
    made.texels = kSkyTexels;
  if (made.texels > 0 && context.spectra.variants() == Variants::spectral &&
      !context.report_unsupported("lights", p.where(made.light->sun() ? "sky" : "filename"),
                                  "images of lights are for mono and rgb variants: give one wavelength or three",
                                  "its colours are kept, with smooth spectra that Mitsuba makes of them"))
    return;
  if (plugin.name == "infinite" && made.texels > 0)
    context.warn(plugin.where, "Mitsuba's environment map has other texels: the image is sampled again");
  all.push_back(std::move(made));
}

/// The light itself gives position, direction and intensity, with its scale or power.
void write_light(Context& context, Xml& xml, const LightDescription& description) {
  const ParsedPlugin& plugin = description.plugin;
  const LightInfo& info = context.registry.lights.get(plugin.name, plugin.where);
  const Params p(info, plugin, context.resolver);
  const auto light = make_checked(info, plugin.where, [&] { return info.make(p, description.world_from_light); });
  if (plugin.name == "spot") return write_spot(context, xml, *light, p, plugin);
  if (plugin.name == "distant") {
    const auto irradiance = emitted(context, 1, [&](const SampledWavelengths& lambda) {
      return light->sample({}, {0.5f, 0.5f}, lambda)->radiance;
    });
    const Element emitter(xml, "emitter", {{"type", "directional"}});
    SampledWavelengths lambda = context.spectra.strategy().sample(0);
    xml.vector("direction", -light->sample({}, {0.5f, 0.5f}, lambda)->wi);
    return context.spectra.write(xml, "irradiance", irradiance);
  }
  if (plugin.name == "point") {
    const Vec3 position = light->bounds()->min;
    const Element emitter(xml, "emitter", {{"type", "point"}});
    xml.point("position", position * float(context.units));
    return context.spectra.write(xml, "intensity", intensity(context, *light, position, {0, 0, 1}));
  }
  context.report_unsupported("lights", plugin.where,
                             fmt::format("light \"{}\" has no equivalent in Mitsuba", plugin.name), "it is left out");
}

}  // namespace

void write_lights(Context& context, Xml& xml) {
  std::vector<Surroundings> surroundings;
  for (const LightDescription& light : context.description.lights)
    context.problems.attempt([&] {
      if (light.plugin.name == "infinite" || light.plugin.name == "sky")
        add_surroundings(context, light, surroundings);
      else
        write_light(context, xml, light);
    });
  if (context.problems.empty()) write_surroundings(context, xml, surroundings);
}

}  // namespace frond::mitsuba
