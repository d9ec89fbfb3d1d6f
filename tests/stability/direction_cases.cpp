#include <limits>

#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

using test::flag;
using test::number;
using test::words;

/// Unit vector with the z coordinate `z`.
Vec3 at_height(float z, float phi) {
  const float r = std::sqrt(std::max(0.f, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

bool is_sound(float x) { return x >= 0 && x <= std::numeric_limits<float>::max(); }
bool is_sound(const SampledSpectrum& s) { return is_sound(s[0]) && s[1] == 0 && s[2] == 0 && s[3] == 0; }

/// Checks f and pdf of a pair of directions.
void check_pair(Comparison& c, const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  RandomStream rng(3);
  const SampledSpectrum f = bsdf.f(wo, wi, rng);
  const float pdf = bsdf.pdf(wo, wi);
  c.require(is_sound(f), fmt::format("f at heights {} and {} is {}", wo.z, wi.z, f[0]));
  c.require(is_sound(pdf), fmt::format("pdf at heights {} and {} is {}", wo.z, wi.z, pdf));
  const bool in_plane = wo.z == 0 || wi.z == 0;
  c.require(!in_plane || (f.is_black() && pdf == 0), "a direction in the plane scatters");
}

void check_samples(Comparison& c, const Bsdf& bsdf, const Vec3& wo, float heaviest) {
  RandomStream rng(4);
  for (int i = 0; i < 2000; ++i) {
    const float uc = rng.uniform(), u = rng.uniform();
    const auto s = bsdf.sample(wo, uc, {u, rng.uniform()}, rng);
    if (!s) continue;
    c.require(wo.z != 0, "a direction in the plane is sampled");
    c.require(is_sound(s->f) && is_sound(s->pdf) && s->pdf > 0,
              fmt::format("a sample for height {} is no number", wo.z));
    c.require(std::abs(length(s->wi) - 1) < 1e-5f && s->wi.z != 0, "a sample's direction is not a unit vector");
    const float weight = s->f[0] * std::abs(s->wi.z) / s->pdf;
    c.require(weight >= 0 && weight < heaviest, fmt::format("a sample for height {} has the weight {}", wo.z, weight));
  }
}

/// Random numbers at the ends of their intervals.
void check_corners(Comparison& c, const Bsdf& bsdf, const Vec3& wo) {
  constexpr float kAlmostOne = 0x1.fffffep-1f;
  for (const float uc : {0.f, 0.03f, kAlmostOne})
    for (const float u : {0.f, 0.5f, kAlmostOne})
      for (const float v : {0.f, 0.5f, kAlmostOne}) {
        RandomStream rng(6);
        const auto s = bsdf.sample(wo, uc, {u, v}, rng);
        c.require(!s || (is_sound(s->f) && is_sound(s->pdf) && s->wi.z != 0), "a corner of the square gives no number");
      }
}

/// One material with each of several surfaces.
std::vector<std::unique_ptr<Specimen>> with_surfaces(std::string_view material, const Parameters& params) {
  std::vector<std::unique_ptr<Specimen>> specimens;
  for (const double exponent : {0.0, 5.0, 1000.0}) {
    Parameters all = params;
    all.push_back(number("float", "cuticleaspect", {exponent}));
    specimens.push_back(std::make_unique<Specimen>(material, std::move(all), 551));
  }
  return specimens;
}

/// Cosines on both sides of the threshold below which they count as 0, and the smallest floats.
constexpr float kHeights[] = {1, 1e-3f, 1e-10f, 1.0001e-20f, 0.9999e-20f, 1e-30f, 1e-44f, 0};

void check_height(Comparison& c, const Bsdf& bsdf, float z, float heaviest) {
  const Vec3 wo = at_height(z, 0);
  for (const float height : kHeights)
    for (const float sign : {1.f, -1.f})
      for (const float phi : {0.f, 1.f, kPi}) check_pair(c, bsdf, wo, at_height(sign * height, phi));
  check_pair(c, bsdf, wo, wo);
  check_pair(c, bsdf, wo, -wo);
  check_samples(c, bsdf, wo, heaviest);
  check_corners(c, bsdf, wo);
}

Cell check_surfaces(const std::vector<std::unique_ptr<Specimen>>& specimens, float z, float heaviest = 1.0001f) {
  Comparison c;
  for (const auto& specimen : specimens)
    for (const float sign : {1.f, -1.f}) check_height(c, specimen->bsdf(), sign * z, heaviest);
  return c.cell();
}

}  // namespace

Theme directions() {
  Theme theme{
      "Directions in and near the surface's plane",
      "f, pdf and sample for wo at this cos theta on both sides and wi at each of these cosines on both sides, at "
      "azimuths of 0, 1 and pi, and for wi = wo and wi = -wo. Surfaces have the exponents 0, 5 and 1000. sample is "
      "called with random numbers inside their intervals and at the ends. The column \"simplified\" has "
      "\"surfacedirect\" true; \"simplified, walked\" has it false and a table of walks."};
  const auto abm = with_surfaces("abm", {});
  const auto simplified = with_surfaces("leaf_simplified", {words("tablemethod", {"solve"})});
  const auto solved = with_surfaces("leaf_solved", {}), lambert = with_surfaces("leaf_lambert", {});
  const auto published = with_surfaces(
      "leaf_simplified",
      {words("tablemethod", {"montecarlo"}), number("integer", "tablerays", {1000}), flag("surfacedirect", false)});
  for (const float z : kHeights)
    theme
        .add(z > 0 && z < 1e-38f ? "cos theta = 1e-44, denormal" : fmt::format("cos theta = {:g}", z),
             z == 0 ? "no light: f = pdf = 0, no sample"
                    : "finite, not negative; weights at most 1 (leaf_solved: 4); 0 if wi is in the plane")
        .add(Method::abm, check_surfaces(abm, z))
        .add(Method::simplified, check_surfaces(simplified, z))
        .add(Method::simplified_walked, check_surfaces(published, z))
        .add(Method::solved_leaf, check_surfaces(solved, z, 4))
        .add(Method::lambert, check_surfaces(lambert, z));
  return theme;
}

}  // namespace frond::stability
