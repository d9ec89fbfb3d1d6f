#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/bsdf.h"
#include "exports/format.h"
#include "instruments/cubature.h"
#include "instruments/goniophotometer.h"
#include "instruments/spectrophotometer.h"

namespace frond {
namespace {

constexpr ExportOption kOslOptions[] = {ExportOption::rays};
constexpr size_t kAngles = 37;  // every 2.5 degrees
constexpr double kLastAngle_deg = 89.5;
constexpr int64_t kRays = 1'000'000;
using Color = std::array<double, 3>;

double angle_deg(size_t i) { return std::min(kLastAngle_deg, 90.0 * double(i) / double(kAngles - 1)); }

/// Shares of the light reflected and transmitted by one side, by angle.
struct SideTable {
  std::array<Color, kAngles> surface{}, body{}, transmitted{};  ///< Rs, Rd, T
  double exponent = 0;  ///< exponent of the cosine in the surface's lobe about the mirror direction
};

/// Mean cosine between the normal and light that the surface reflects at normal incidence.
struct SurfaceTally {
  float lit_side;
  Moments cosines = {};

  void add(const Scattered& ray) {
    if (any(ray.lobe & Lobes::surface) && ray.weight[0] > 0 && ray.direction.z * lit_side > 0)
      cosines.add(double(std::abs(ray.direction.z)));
  }
  void add(const SurfaceTally& other) { cosines.add(other.cosines); }
  void clear() { cosines = {}; }
};

/// Returns the exponent e of a lobe whose share of the light is proportional to (cos alpha)^e about the mirror
/// direction. At normal incidence the mean of cos alpha is (e + 1) / (e + 2).
double surface_exponent(const LitMaterial& along_normal, int64_t rays, const ThreadPool& pool) {
  SurfaceTally tally{toward_light(along_normal.beam).z};
  tally_rays(along_normal, 0, rays, tally, pool, {});
  if (tally.cosines.count() == 0) return 1;
  const double mean = tally.cosines.mean();
  return std::max(1.0, (2 * mean - 1) / (1 - mean));
}

/// Returns the albedo of Cycles' phong_ramp: the integral of (e + 2) / 2 pi (cos alpha)^e over projected solid angle.
double phong_albedo(double exponent, double theta_deg) {
  constexpr double kNegligible = 1e-9;
  const double theta = theta_deg * std::numbers::pi / 180, s = std::sin(theta), c = std::cos(theta);
  const Density density = [&](const Vec3& w) {
    const double cosine = -s * double(w.x) + c * double(w.z);
    return cosine > 0 ? (exponent + 2) / (2 * std::numbers::pi) * std::pow(cosine, exponent) * double(w.z) : 0;
  };
  const std::array mirror{SpherePoint({float(-s), 0, float(c)})};
  return total(integrate({0, 1, 0, 2 * std::numbers::pi}, density, kNegligible, mirror));
}

/// Measures the shares at one wavelength. Returns whether the material separates surface from subsurface scattering.
bool measure(const ExportMaterial& material, const ExportedBsdf& bsdf, bool front, size_t channel, int64_t rays,
             SideTable& side) {
  const double nm = bsdf.wavelengths_nm()[0];
  const uint64_t seed = material.seed;
  const auto lit_at = [&](double theta_deg) {
    return LitMaterial{bsdf.material(), {front ? theta_deg : 180 - theta_deg, nm}, seed};
  };
  constexpr int kThetas = 4, kPhis = 6;
  bool distinguishes_surface = true;
  for (size_t i = 0; i < kAngles; ++i) {
    const GoniophotometerMeasurement whole =
        integrate_f(lit_at(angle_deg(i)), DetectorSphere(kThetas, kPhis), material.pool);
    const SpectrophotometerMeasurement parts = measure_shares(lit_at(angle_deg(i)), {.rays = rays}, material.pool);
    distinguishes_surface = distinguishes_surface && parts.distinguishes_surface;
    const double reflected = whole.share(true).mean;
    const double surface = parts.distinguishes_surface ? std::min(parts.surface.mean, reflected) : 0;
    side.surface[i][channel] = surface;
    side.body[i][channel] = reflected - surface;
    side.transmitted[i][channel] = whole.share(false).mean;
  }
  if (channel == 0) side.exponent = surface_exponent(lit_at(0), rays, material.pool);
  return distinguishes_surface;
}

/// Returns an OSL array literal: the front's angles, then the back's.
std::string array_text(const char* name, const char* doc, const std::array<std::array<Color, kAngles>, 2>& sides) {
  std::string text = fmt::format("    // {}\n    color {}[{}] = {{", doc, name, 2 * kAngles);
  for (const auto& side : sides)
    for (const Color& c : side) {
      const bool is_last = &c == &sides[1].back();
      text += fmt::format("\n        color({:.6f}, {:.6f}, {:.6f}){}", c[0], c[1], c[2], is_last ? "};\n" : ",");
    }
  return text;
}

constexpr const char* kHead =
    R"(// Three lobes as in Baranoski and Rokne's simplified model, weighted by the viewing angle and side: a power of the
// cosine about the mirror direction, a diffuse reflection and a diffuse transmission. Red, green and blue are
// {:g}, {:g} and {:g} nm. At each angle the shares of the light equal those of frond's material; their distribution
// over directions is an approximation (docs/other_renderers.md states its error).

// A lobe of Cycles (stdcycles.h): (e + 2) / 2 pi (cos alpha)^e, alpha from the mirror direction.
closure color phong_ramp(normal N, float exponent, color colors[8]) [[int builtin = 1]];

color at_angle(color shares[{}], int side, float place)
{{
    int below = min(int(place), {});
    int i = side * {} + below;
    return mix(shares[i], shares[i + 1], place - below);
}}

shader frond_leaf(normal Normal = N, output closure color BSDF = 0)
{{
    // From the front's normal to 90 degrees in even steps, then from the back's.
)";

constexpr const char* kTail =
    R"(    color white[8] = {{color(1), color(1), color(1), color(1), color(1), color(1), color(1), color(1)}};
    float exponents[2] = {{{:.4f}, {:.4f}}};
    int side = backfacing();
    float place = acos(clamp(fabs(dot(I, Normal)), 0.0, 1.0)) * ({} / M_PI_2);
    BSDF = at_angle(surface, side, place) * phong_ramp(Normal, exponents[side], white) +
           at_angle(body, side, place) * diffuse(Normal) +
           at_angle(transmitted, side, place) * translucent(Normal);
}}
)";

/// Default wavelengths are the paper's.
std::vector<double> colors_of(const ExportRequest& request) {
  return request.wavelengths_nm.empty() ? std::vector<double>{608, 551, 455} : request.wavelengths_nm;
}

void check_osl(const ExportRequest& request) {
  if (const size_t n = colors_of(request).size(); n != 3)
    fail({}, "the format osl takes three wavelengths, red, green and blue; {} were given", n);
}

std::string osl_file(const ExportMaterial& material, const ExportRequest& request) {
  const auto nm = colors_of(request);
  const int64_t rays = request.rays == 0 ? kRays : request.rays;
  std::array<SideTable, 2> sides;
  bool distinguishes_surface = true;
  for (size_t channel = 0; channel < nm.size(); ++channel) {
    const ExportedBsdf bsdf(material, {nm[channel]});
    if (any(ExportedBsdf::At(bsdf).bsdf().flags() & Lobes::from_light))
      fail({},
           "{}: its shares depend on the light's direction, those of an OSL closure on the viewer's: leave "
           "incident=light out",
           material.label);
    for (const bool front : {true, false})
      distinguishes_surface &= measure(material, bsdf, front, channel, rays, sides[front ? 0 : 1]);
  }
  if (!distinguishes_surface)
    material.log.warn({}, "the material does not tell its surface from its body: all that it reflects is diffuse here");
  std::array<std::array<Color, kAngles>, 2> surface;
  for (size_t s = 0; s < 2; ++s)
    for (size_t i = 0; i < kAngles; ++i) {
      const double albedo = phong_albedo(sides[s].exponent - 1, angle_deg(i));
      for (size_t c = 0; c < 3; ++c) surface[s][i][c] = sides[s].surface[i][c] / albedo;
    }
  std::string text = "// frond " FROND_VERSION " export, " + material.label + "\n//\n";
  text += fmt::format(kHead, nm[0], nm[1], nm[2], 2 * kAngles, kAngles - 2, kAngles);
  text += array_text("surface", "Rs, over what the lobe by itself sends on.", surface);
  text += array_text("body", "Rd.", {sides[0].body, sides[1].body});
  text += array_text("transmitted", "T.", {sides[0].transmitted, sides[1].transmitted});
  // Cycles weights its lobe by the cosine with the normal; at normal incidence this is one more power.
  return text + fmt::format(kTail, sides[0].exponent - 1, sides[1].exponent - 1, kAngles - 1);
}

}  // namespace

extern const ExportFormat osl_format{
    "osl", "an OSL shader of three lobes for Blender's Cycles", true, kOslOptions, check_osl, osl_file};

}  // namespace frond
