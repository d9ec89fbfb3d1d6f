#include "exports/mitsuba/environment.h"

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"
#include "lights/sky_model.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"

namespace frond::mitsuba {
namespace {

/// Rows of the map by latitude and longitude for each row of a square image: its texels are then narrower.
constexpr int kRowsPerRow = 16, kMostRows = 2048;

/// Sun of a sky: Mitsuba's parallel light has its irradiance, the image is without its disc.
struct Sun {
  Vec3 toward;
  double radius;     ///< of a circle around the disc, rad
  double projected;  ///< solid angle of the disc, projected on a plane that faces it
};

Sun sun_of(const Context& context, const Surroundings& sky) {
  const ParsedPlugin& plugin = sky.description.plugin;
  const SkyModel model(Params(context.registry.lights.get(plugin.name, plugin.where), plugin, context.resolver));
  const double sine = std::sin(model.sun_radius);
  return {*sky.light->sun(), 1.05 * model.sun_radius, kPiD * sine * sine / model.horizon_factor()};
}

/// Returns the direction; a direction on the sun's disc is moved to the nearest one outside of the disc.
Vec3 move_off_disc(const Sun& sun, const Vec3& d) {
  if (length(d - sun.toward) >= float(2 * std::sin(sun.radius / 2))) return d;
  const Frame frame = Frame::around(sun.toward);
  const Vec3 local = frame.to_local(d);
  const float off_axis = std::hypot(local.x, local.y), sine = float(std::sin(sun.radius));
  const bool is_center = off_axis < 1e-5f;  // rounding has no direction
  return frame.to_world({is_center ? sine : local.x * (sine / off_axis), is_center ? 0 : local.y * (sine / off_axis),
                         float(std::cos(sun.radius))});
}

/// Radiance of a light without the disc of its sun.
class Radiance {
 public:
  Radiance(const Context& context, const Surroundings& from)
      : light_(dynamic_cast<const EnvironmentLight&>(*from.light)) {
    if (from.light->sun()) sun_ = sun_of(context, from);
  }
  SampledSpectrum at(const Vec3& d, const SampledWavelengths& lambda) const {
    return light_.radiance({}, sun_ ? move_off_disc(*sun_, d) : d, lambda);
  }
  /// Irradiance of the disc at normal incidence: its radiance minus the radiance of the sky beside it.
  SampledSpectrum sun_irradiance(const SampledWavelengths& lambda) const {
    const SampledSpectrum disc = light_.radiance({}, sun_->toward, lambda), sky = at(sun_->toward, lambda);
    return (disc + sky * -1) * float(sun_->projected);
  }
  const std::optional<Sun>& sun() const { return sun_; }

 private:
  const EnvironmentLight& light_;
  std::optional<Sun> sun_;
};

/// Linear sRGB of a spectrum at the wavelengths of an export, with which Mitsuba's spectral variants have its colour.
class ColorOf {
 public:
  explicit ColorOf(const Spectra& spectra) {
    const std::vector<double>& nm = spectra.wavelengths_nm();
    for (size_t i = 0; i < nm.size(); ++i) {
      const double below = i > 0 ? nm[i - 1] : nm[i], above = i + 1 < nm.size() ? nm[i + 1] : nm[i];
      const Triple xyz = cie_xyz(nm[i]);
      const Triple rgb = find_color_space("srgb")->rgb_from_xyz * xyz;
      for (size_t c = 0; c < 3; ++c) weights_[c].push_back(rgb[c] * (above - below) / 2);
    }
  }
  double operator()(size_t channel, const std::vector<double>& values) const {
    double sum = 0;
    for (size_t i = 0; i < values.size(); ++i) sum += weights_[channel][i] * values[i];
    return std::max(0., sum);
  }

 private:
  std::array<std::vector<double>, 3> weights_;
};

/// Axes of the image in the world: y, which Mitsuba takes as up, is the sky's zenith; without a sky, the axes of the
/// world.
Frame axes_of(const std::vector<Surroundings>& lights) {
  for (const Surroundings& s : lights)
    if (s.description.plugin.name == "sky") {
      const Vec3 up = normalize(s.description.world_from_light.vector({0, 0, 1}));
      const Frame around = Frame::around(up);
      return {around.y, around.z, around.x};
    }
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

/// The sum of all lights as a map by latitude and longitude, because Mitsuba has no other.
void write_image(Context& context, Xml& xml, const std::vector<Surroundings>& lights,
                 const std::vector<Radiance>& radiances) {
  int height = 0;
  for (const Surroundings& s : lights)
    height = std::max({height, 2 * s.texels, std::min(kRowsPerRow * s.texels, kMostRows)});
  const int width = 2 * height;
  const Spectra& spectra = context.spectra;
  const bool is_spectral = spectra.variants() == Variants::spectral;
  const std::optional<ColorOf> color = is_spectral ? std::optional<ColorOf>(spectra) : std::nullopt;
  const Frame axes = axes_of(lights);
  Image image(width, height, {"R", "G", "B"});
  context.pool.for_each(height, [&](int64_t row, int) {
    const int y = int(row);
    for (int x = 0; x < width; ++x) {
      // Mitsuba: u = atan2(x, -z) / 2 pi, v = acos(y) / pi, at pixel centres.
      const double phi = 2 * kPiD * (x + 0.5) / width, theta = kPiD * (y + 0.5) / height;
      const Vec3 d = axes.to_world(
          to_float(Vec3d{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)}));
      std::vector<double> values = spectra.values([&](const SampledWavelengths& lambda) {
        SampledSpectrum sum;
        for (const Radiance& r : radiances) sum += r.at(d, lambda);
        return sum;
      });
      if (!is_spectral) values = spectra.emission(std::move(values), context.exposure);
      for (size_t c = 0; c < 3; ++c)
        image.at(x, y, c) =
            float(is_spectral ? context.exposure * (*color)(c, values) : values[values.size() > 1 ? c : 0]);
    }
  });
  const Element emitter(xml, "emitter", {{"type", "envmap"}});
  xml.text("filename", context.folder.add("textures", "sky", image));
  if (axes.y == Vec3{0, 1, 0}) return;
  const auto row = [](float x, float y, float z) { return std::array<double, 4>{double(x), double(y), double(z), 0}; };
  xml.matrix("to_world", {{row(axes.x.x, axes.y.x, axes.z.x), row(axes.x.y, axes.y.y, axes.z.y),
                           row(axes.x.z, axes.y.z, axes.z.z)}});
}

}  // namespace

void write_surroundings(Context& context, Xml& xml, const std::vector<Surroundings>& lights) {
  if (lights.empty()) return;
  std::vector<Radiance> radiances;
  for (const Surroundings& s : lights) radiances.emplace_back(context, s);
  const Spectra& spectra = context.spectra;
  for (const Radiance& r : radiances) {
    if (!r.sun()) continue;
    const Element emitter(xml, "emitter", {{"type", "directional"}});
    xml.vector("direction", -r.sun()->toward);
    const auto values = spectra.values([&](const SampledWavelengths& lambda) { return r.sun_irradiance(lambda); });
    spectra.write(xml, "irradiance", spectra.emission(values, context.exposure));
  }
  if (std::ranges::any_of(lights, [](const Surroundings& s) { return s.texels > 0; }))
    return write_image(context, xml, lights, radiances);
  const auto values = spectra.values([&](const SampledWavelengths& lambda) {
    SampledSpectrum sum;
    for (const Radiance& r : radiances) sum += r.at({0, 0, 1}, lambda);
    return sum;
  });
  const Element emitter(xml, "emitter", {{"type", "constant"}});
  spectra.write(xml, "radiance", spectra.emission(values, context.exposure));
}

}  // namespace frond::mitsuba
