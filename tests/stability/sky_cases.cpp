#include <cmath>
#include <numbers>

#include "core/math/random.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "spectra/spectrl2.h"
#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/support/render_text.h"

namespace frond::stability {
namespace {

constexpr double kSkyNm = 550;

/// A sky, and the irradiance of a horizontal plane at 550 nm by SPECTRL2.
struct Case {
  std::string name, params;
  double irradiance;
  bool has_ground = false;
};

double horizontal(const Atmosphere& air) {
  const ClearSkyIrradiance e = spectrl2(air);
  const auto i = size_t(std::ranges::find(e.nm, kSkyNm) - e.nm.begin());
  return e.direct_normal[i] * std::cos(air.sun_zenith_deg * kDegree) + e.diffuse[i];
}

std::string light(const std::string& params) { return "LightSource \"sky\" " + params + "\n"; }

Cell of_light(const Case& c) {
  SceneDescription description = parse_scene_text("WorldBegin\n" + light(c.params), "sky", silent_log());
  set_wavelengths(description, "bands,wavelengths=300,550,1100,2500");
  ThreadPool pool(1);
  const Scene scene(description, make_registry(builtin_materials(), builtin_integrators()), pool, silent_log());
  const EnvironmentLight& sky = *scene.environment()[0];
  const SampledWavelengths lambda = scene.wavelengths().sample(0.5f);
  Comparison comparison(5e-3);
  const auto is_sound = [](float x) { return x >= 0 && std::isfinite(x); };
  const auto check = [&](const Vec3& d) {
    const SampledSpectrum radiance = sky.radiance({}, d, lambda);
    comparison.require(radiance.is_physical(), "a radiance is negative or not finite");
    comparison.require(d.z > 0 || radiance.is_black() || c.has_ground, "there is light below the horizon");
    comparison.require(is_sound(sky.pdf({}, d)) && is_sound(sky.compensated_pdf({}, d)), "a density is no number");
  };
  constexpr int kRings = 201, kSectors = 144;  // heights that include 0, 1 and -1
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSectors; ++j) {
      const double z = 2.0 * i / (kRings - 1) - 1, r = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * j / kSectors;
      check(to_float(Vec3d{r * std::cos(phi), r * std::sin(phi), z}));
    }
  if (const auto sun = sky.sun()) check(*sun);
  RandomStream random(5);
  constexpr int kSamples = 20000;
  Estimate sum{0, 0};
  double squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = sky.sample({}, {random.uniform(), random.uniform()}, lambda);
    const double value = s ? double(s->radiance[1]) * double(std::max(0.f, s->wi.z)) / double(s->pdf) : 0;
    comparison.require(!s || (s->radiance.is_physical() && s->pdf > 0), "a sample is no number");
    sum.mean += value / kSamples, squares += value * value / kSamples;
  }
  sum.variance = std::max(0.0, squares - sum.mean * sum.mean) / kSamples;
  if (c.irradiance > 0) {
    sum.mean /= c.irradiance, sum.variance /= c.irradiance * c.irradiance;
    comparison.add("irradiance", sum, 1, kSamples);
  } else {
    comparison.require(sum.mean == 0, "the light is not black");
  }
  return comparison.cell();
}

Cell of_render(const Case& c) {
  const std::string scene = fmt::format(R"(LookAt 0 0 4  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -0.5 0.5 -0.5 0.5 ]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 2
WorldBegin
{}Material "diffuse" "spectrum reflectance" [ 300 1 2500 1 ]
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2  0 2 3 ]
)",
                                        light(c.params));
  constexpr int kSamples = 64;
  const Film film = test::render_text(scene, {.samples = kSamples, .wavelengths = "bands,wavelengths=550"});
  double mean = 0, error2 = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const auto pixel = film.band_mean(x, y, 0);
      mean += pixel.mean / 64, error2 += pixel.variance / (64 * 64);
    }
  Comparison comparison;
  comparison.require(film.not_finite() == 0, "a sample is no number");
  if (c.irradiance > 0)
    comparison.add(
        "irradiance",
        Estimate{mean * std::numbers::pi / c.irradiance, error2 * std::pow(std::numbers::pi / c.irradiance, 2)}, 1,
        64 * kSamples);
  else
    comparison.require(mean == 0, "the image is not black");
  return comparison.cell();
}

Cell of_refusal(const std::string& params, std::string_view part) {
  return refusal(part, [&] {
    ThreadPool pool(1);
    const SceneDescription d = parse_scene_text("WorldBegin\n" + light(params), "sky", silent_log());
    const Scene scene(d, make_registry(builtin_materials(), builtin_integrators()), pool, silent_log());
  });
}

}  // namespace

Theme skies() {
  Theme theme{
      "Sky light",
      "Irradiance of a horizontal plane at 550 nm, relative to SPECTRL2's. Every radiance and density is finite and "
      "not negative, and black below the horizon unless there is an albedo."};
  std::vector<Case> cases;
  for (const double elevation : {90.0, 89.99, 45.0, 5.0, 1.0, 0.1})
    cases.push_back({fmt::format("sun {:g} degrees above the horizon", elevation),
                     fmt::format("\"float elevation\" {}", elevation), horizontal({.sun_zenith_deg = 90 - elevation})});
  for (const double elevation : {0.0, -0.01, -90.0})
    cases.push_back(
        {fmt::format("sun at {:g} degrees", elevation), fmt::format("\"float elevation\" {}", elevation), 0});
  for (const double aerosol : {0.0, 1.0, 10.0})
    for (const double elevation : {60.0, 2.0})
      cases.push_back({fmt::format("aerosol {:g}, sun at {:g} degrees", aerosol, elevation),
                       fmt::format("\"float aerosol\" {} \"float elevation\" {}", aerosol, elevation),
                       horizontal({.sun_zenith_deg = 90 - elevation, .aerosol = aerosol})});
  for (const double angstrom : {-1.0, 4.0})
    cases.push_back({fmt::format("aerosol 1, angstrom {:g}", angstrom),
                     fmt::format("\"float aerosol\" 1 \"float angstrom\" {}", angstrom),
                     horizontal({.aerosol = 1, .angstrom = angstrom})});
  cases.push_back({"pressure 0, aerosol 0: no air", "\"float pressure\" 0 \"float aerosol\" 0",
                   horizontal({.aerosol = 0, .pressure_Pa = 0})});
  cases.push_back({"albedo 1", "\"float albedo\" 1", horizontal({.albedo = 1}), true});
  cases.push_back({"overcast, sun at 60 degrees", "\"string sky\" \"overcast\"", horizontal({}) / 4});
  for (const int type : {1, 5, 15})
    cases.push_back({fmt::format("cietype {}", type), fmt::format("\"integer cietype\" {}", type), horizontal({})});
  for (const Case& c : cases)
    theme.add(c.name, c.irradiance > 0 ? "irradiance 1, sky within 5e-3" : "black")
        .add(Method::sky_light, of_light(c))
        .add(Method::path_sky, of_render(c));
  for (const auto& [params, part] :
       {std::pair<std::string, std::string>{"\"float elevation\" 90.1", "outside its range -90 to 90 degrees"},
        {"\"float aerosol\" -1e-9", "outside its range 0 to 10"},
        {"\"float water\" nan", "a number is needed"},
        {"\"vector3 sundirection\" [ 0 0 0 ]", "it is no direction"}})
    theme.add(params, expect_refusal(part)).add(Method::sky_light, of_refusal(params, part));
  return theme;
}

}  // namespace frond::stability
