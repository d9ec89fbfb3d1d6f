#include "exports/mitsuba/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/light.h"
#include "image/image_file.h"

namespace frond::mitsuba {
namespace {

constexpr double kPiD = std::numbers::pi;

/// Values of a light at a point or in a direction, in Mitsuba's unit.
template <class At>
std::vector<double> emitted(const Context& context, double scale, const At& at) {
  return context.spectra.emission(context.spectra.values(at), scale * context.exposure);
}

/// Rows of the map by latitude and longitude for each row of the square image: its texels are then narrower.
constexpr int kRowsPerRow = 16, kMostRows = 2048;

/// Writes an image light as a map by latitude and longitude, because Mitsuba has no other.
void write_environment(Context& context, Xml& xml, const EnvironmentLight& light, const Params& p,
                       const ParsedPlugin& plugin, int texels) {
  if (context.spectra.variants() == Variants::spectral)
    fail(p.where("filename"), "images of lights are for mono and rgb variants: give one wavelength or three");
  context.warn(plugin.where, "Mitsuba's environment map has other texels: the image is sampled again");
  const bool is_mono = context.spectra.variants() == Variants::mono;
  const int height = std::max(std::min(kRowsPerRow * texels, kMostRows), 2 * texels), width = 2 * height;
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // Mitsuba: u = atan2(x, -z) / 2 pi, v = acos(y) / pi, at pixel centres.
      const double phi = 2 * kPiD * (x + 0.5) / width, theta = kPiD * (y + 0.5) / height;
      const Vec3 d =
          to_float(Vec3d{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)});
      const auto values =
          emitted(context, 1, [&](const SampledWavelengths& lambda) { return light.radiance({}, d, lambda); });
      for (size_t c = 0; c < 3; ++c) image.at(x, y, c) = float(values[is_mono ? 0 : c]);
    }
  const Element emitter(xml, "emitter", {{"type", "envmap"}});
  xml.text("filename", context.folder.add("textures", "sky", image));
}

/// Uniform or with an image.
void write_infinite(Context& context, Xml& xml, const Light& light, const Params& p, const ParsedPlugin& plugin) {
  if (p.given("portal")) fail(p.where("portal"), "a light with a portal has no equivalent in Mitsuba");
  const auto& environment = dynamic_cast<const EnvironmentLight&>(light);
  if (p.given("filename")) {
    const Image image = read_image(p.file("filename"), p.where("filename")).image;
    return write_environment(context, xml, environment, p, plugin, image.width);
  }
  const auto radiance = emitted(context, 1, [&](const SampledWavelengths& lambda) {
    return environment.radiance({}, {0, 0, 1}, lambda);
  });
  const Element emitter(xml, "emitter", {{"type", "constant"}});
  context.spectra.write(xml, "radiance", radiance);
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

/// The light itself gives position, direction and intensity, with its scale or power.
void write_light(Context& context, Xml& xml, const LightDescription& description) {
  const ParsedPlugin& plugin = description.plugin;
  const LightInfo& info = context.registry.lights.get(plugin.name, plugin.where);
  const Params p(info, plugin, context.resolver);
  const auto light = made_by(info, plugin.where, [&] { return info.make(p, description.world_from_light); });
  if (plugin.name == "infinite") return write_infinite(context, xml, *light, p, plugin);
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
  fail(plugin.where, "light \"{}\" has no equivalent in Mitsuba", plugin.name);
}

}  // namespace

void write_lights(Context& context, Xml& xml) {
  for (const LightDescription& light : context.description.lights) write_light(context, xml, light);
}

}  // namespace frond::mitsuba
