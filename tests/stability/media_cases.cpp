#include <cmath>
#include <numbers>

#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/support/render_text.h"

namespace frond::stability {
namespace {

using test::channel_mean;
using test::render_text;

const std::string kMediaSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n";
constexpr int kMediaSamples = 256;
constexpr int64_t kMediaPaths = 64 * kMediaSamples;

/// A camera that looks down from z = 3 on a point of the plane z = 0.
std::string looking_down(const std::string& world) {
  return "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1e-3 1e-3 -1e-3 1e-3]\n"
         "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nSampler \"independent\"\n"
         "PixelFilter \"box\"\nIntegrator \"volpath\" \"integer maxdepth\" 10000\nWorldBegin\n" +
         world;
}

/// A medium of each type in a box from -1 to 1; `sigma` are its coefficients.
struct Type {
  Method method;
  std::string (*with)(double sigma_a, double sigma_s, double g);
};
std::string coefficients(double a, double s, double g) {
  return fmt::format("\"float sigma_a\" {} \"float sigma_s\" {} \"float g\" {}", a, s, g);
}
constexpr std::string_view kBox = " \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] ";
const Type kTypes[] = {
    {Method::homogeneous,
     [](double a, double s, double g) { return "\"string type\" \"homogeneous\" " + coefficients(a, s, g); }},
    {Method::uniform_grid,
     [](double a, double s, double g) {
       return fmt::format("\"string type\" \"uniformgrid\" \"integer nz\" 3 \"float density\" [.2 1 .5] {} {}", kBox,
                          coefficients(a, s, g));
     }},
    {Method::rgb_grid,
     [](double a, double s, double g) {
       return fmt::format(
           "\"string type\" \"rgbgrid\" \"integer nz\" 2 \"rgb sigma_a\" [{0} {0} {0}  {0} {0} {0}] "
           "\"rgb sigma_s\" [{1} {1} {1}  {1} {1} {1}] \"float g\" {2} {3}",
           a, s, g, kBox);
     }},
    {Method::cloud,
     [](double a, double s, double g) {
       return fmt::format("\"string type\" \"cloud\" {} {}", kBox, coefficients(a, s, g));
     }},
    {Method::nanovdb, [](double a, double s, double g) {
       return fmt::format("\"string type\" \"nanovdb\" \"string filename\" \"" FROND_SOURCE_DIR
                          "/tests/pbrt_reference/torus.nvdb\" {}",
                          coefficients(a, s, g));
     }}};

std::string ball_of(const std::string& medium) {
  return "MakeNamedMedium \"m\" " + medium +
         "\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\nShape \"sphere\" \"float radius\" 1.5\n";
}

/// Mean radiance against `truth`, in each channel.
Cell radiance(const std::string& world, double truth) {
  const Film film = render_text(looking_down(world), {.samples = kMediaSamples});
  Comparison comparison(2e-4);
  comparison.require(film.not_finite() == 0, "a sample is no number");
  for (size_t c = 0; c < 3; ++c) {
    const auto [mean, error] = channel_mean(film, c);
    comparison.add("radiance", Estimate{mean, error * error}, truth, kMediaPaths);
  }
  return comparison.cell();
}

/// Optical depth of the grid of each type along the axis, for an extinction coefficient of 1; 0: it has no closed form.
double depth_of(Method method) {
  if (method == Method::homogeneous) return 3;
  if (method == Method::uniform_grid) return 2.0 / 3 * (0.2 + 1 + 0.5 - (0.2 + 0.5) / 8);
  if (method == Method::rgb_grid) return 2 - 2.0 / 8;
  return 0;
}

Cell refused(const std::string& medium, std::string_view part) {
  return refusal(part, [&] { (void)render_text(looking_down(ball_of(medium)), {.samples = 1}); });
}

}  // namespace

Theme media() {
  Theme theme{"Media",
              "Radiance of a ball of each medium before a sky of radiance 1, at 608, 551 and 455 nm: 1 without "
              "absorption, by delta tracking and scattering; exp(-t) for the optical depth t of an absorbing medium; "
              "light samples pass it by ratio tracking, or by the transmittance where it is homogeneous."};
  for (const double sigma : {0.0, 1e-6, 1.0, 30.0})
    for (const double g : {-0.99, 0.0, 0.99}) {
      if (sigma != 1 && g != 0) continue;
      Row& row = theme.add(fmt::format("no absorption, sigma_s {:g}, g {:g}", sigma, g), "radiance 1");
      for (const Type& type : kTypes) row.add(type.method, radiance(kMediaSky + ball_of(type.with(0, sigma, g)), 1));
    }
  for (const double sigma : {1e-6, 1.0, 3.0, 1e30}) {
    Row& row = theme.add(fmt::format("no scattering, sigma_a {:g}", sigma), "radiance exp(-t)");
    for (const Type& type : kTypes)
      if (const double depth = depth_of(type.method); depth > 0)
        row.add(type.method, radiance(kMediaSky + ball_of(type.with(sigma, 0, 0)), std::exp(-sigma * depth)));
  }
  const std::string lit_plane =
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-D65\"\n"
      "AttributeBegin\nTranslate 0 0 -2\nMaterial \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\n"
      "Shape \"disk\"\nAttributeEnd\n";
  for (const double sigma : {1e-6, 1.0}) {
    Row& row =
        theme.add(fmt::format("no scattering, sigma_a {:g}, before a white plane that a beam lights through it", sigma),
                  "radiance exp(-2 t) / pi");
    for (const Type& type : kTypes)
      if (const double depth = depth_of(type.method); depth > 0)
        row.add(type.method,
                radiance(lit_plane + ball_of(type.with(sigma, 0, 0)), std::exp(-2 * sigma * depth) / std::numbers::pi));
  }
  theme.add("a grid of zeros", "radiance 1")
      .add(Method::uniform_grid,
           radiance(kMediaSky + ball_of(fmt::format("\"string type\" \"uniformgrid\" \"float density\" 0 {}", kBox)),
                    1));
  theme.add("density 1e6 in one cell of a million, beside the ray", "radiance 1").add(Method::uniform_grid, [] {
    std::string values;
    for (int i = 0; i < 100 * 100 * 100; ++i) values += i == 0 ? "1e6 " : "0 ";
    return radiance(kMediaSky + ball_of(fmt::format("\"string type\" \"uniformgrid\" \"integer nx\" 100 \"integer ny\" "
                                                    "100 \"integer nz\" 100 \"float density\" [{}] {}",
                                                    values, kBox)),
                    1);
  }());
  for (const auto& [medium, part] :
       {std::pair<std::string, std::string>{"\"string type\" \"homogeneous\" \"float sigma_a\" -1e-9", "below 0"},
        {"\"string type\" \"homogeneous\" \"float g\" 1.1", "outside its range -1 to 1"}})
    theme.add(medium, expect_refusal(part)).add(Method::homogeneous, refused(medium, part));
  for (const auto& [medium, part] :
       {std::pair<std::string, std::string>{"\"string type\" \"uniformgrid\" \"float density\" [1 1]",
                                            "nx ny nz = 1 x 1 x 1 = 1 are needed"},
        {"\"string type\" \"uniformgrid\" \"float density\" -1", "outside its range"}})
    theme.add(medium, expect_refusal(part)).add(Method::uniform_grid, refused(medium, part));
  return theme;
}

}  // namespace frond::stability
