#include <numbers>
#include <tuple>

#include "leaf/tissue/specimens.h"
#include "tests/stability/cases.h"
#include "tests/stability/leaf_methods.h"

namespace frond::stability {
namespace {

using leaf::Absorption;
using leaf::find_specimen;
using leaf::Tissue;
using leaf::TissueModel;

constexpr std::array<double, kLanes> kCuticles{1.3, 1.43, 1.57, 1.7};
constexpr int kWalks = 10000;

std::array<Tissue, kLanes> dispersive(const TissueModel& model, double depth) {
  std::array<Tissue, kLanes> tissues;
  for (size_t i = 0; i < kLanes; ++i) {
    tissues[i] = model.at(800);
    tissues[i].n[1] = tissues[i].n[5] = kCuticles[i];
    for (double& d : tissues[i].optical_depth) d = d > 0 ? depth * (1 + double(i)) : 0;
  }
  return tissues;
}

using Pointers = std::array<const Tissue*, kLanes>;

Pointers pointers_to(const std::array<Tissue, kLanes>& tissues) {
  Pointers result;
  for (size_t i = 0; i < kLanes; ++i) result[i] = &tissues[i];
  return result;
}

using LaneShares = std::array<MeasuredShares, kLanes>;

LaneShares walk_spectrally(const Pointers& tissues, double theta_deg, Absorption absorption, Comparison& comparison) {
  LaneShares lanes;
  RandomStream rng(hash_key(7, static_cast<uint64_t>(theta_deg)));
  for (int i = 0; i < kWalks; ++i) {
    const size_t hero = rng.bits() % kLanes;
    const double branch = rng.uniform_double();
    const leaf::SpectralWalkEnd end = leaf::walk(tissues, hero, toward(theta_deg), absorption, {branch, 0, 0}, rng);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane].add(end.fate, end.weight[lane]);
      comparison.require(end.weight[lane] >= 0 && end.weight[lane] <= kLanes, "a weight is not from 0 to 4");
    }
  }
  return lanes;
}

Cell compare_lanes(const std::array<Tissue, kLanes>& tissues, const std::vector<double>& theta_deg,
                   Absorption absorption) {
  Comparison comparison;
  for (const double theta : theta_deg) {
    const LaneShares lanes = walk_spectrally(pointers_to(tissues), theta, absorption, comparison);
    for (size_t lane = 0; lane < kLanes; ++lane)
      add_shares(comparison, lanes[lane], solved_finely(tissues[lane], {theta}).truth[0]);
  }
  return comparison.cell();
}

Vec3d uniform_direction(RandomStream& rng) {
  const double z = 2 * rng.uniform_open() - 1, phi = 2 * std::numbers::pi * rng.uniform_double();
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Rd and T of each wavelength by the integral of f |cos| over the sphere.
Cell compare_lanes_of_f(const std::array<Tissue, kLanes>& tissues, const std::vector<double>& theta_deg,
                        Absorption absorption) {
  Comparison comparison;
  for (const double theta : theta_deg) {
    std::array<Moments, kLanes> above, below;
    RandomStream rng(hash_key(8, static_cast<uint64_t>(theta)));
    for (int i = 0; i < kWalks; ++i) {
      const Vec3d wi = uniform_direction(rng);
      const auto f =
          leaf::estimate_subsurface_f(pointers_to(tissues), rng.bits() % kLanes, toward(theta), wi, absorption, rng);
      const double scale = 4 * std::numbers::pi * std::abs(wi.z);
      for (size_t lane = 0; lane < kLanes; ++lane) {
        above[lane].add(wi.z > 0 ? f[lane] * scale : 0);
        below[lane].add(wi.z < 0 ? f[lane] * scale : 0);
      }
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const leaf::Shares truth = solved_finely(tissues[lane], {theta}).truth[0];
      const auto& [reflected, transmitted] = theta < 90 ? std::tie(above, below) : std::tie(below, above);
      comparison.add("Rd", reflected[lane].estimate(), truth.subsurface, kWalks);
      comparison.add("T", transmitted[lane].estimate(), truth.transmitted, kWalks);
    }
  }
  return comparison.cell();
}

void add_dispersion(Theme& theme, std::string_view specimen, double depth, Absorption absorption) {
  const TissueModel model(find_specimen(specimen)->params);
  const std::string_view mode = absorption == Absorption::analog ? "analog" : "weighted";
  const std::string depths = depth > 0 ? fmt::format("depths {:g} to {:g}", depth, 4 * depth) : "no absorption";
  const std::vector<double> theta_deg{5, 60, 89.5, 140};
  theme.add(fmt::format("{}, {}, {}", specimen, depths, mode), "each wavelength's R and T exact, weights from 0 to 4")
      .add(Method::spectral_walk, compare_lanes(dispersive(model, depth), theta_deg, absorption))
      .add(Method::spectral_f, compare_lanes_of_f(dispersive(model, depth), theta_deg, absorption));
}

}  // namespace

Theme dispersion() {
  Theme theme{
      "Strong dispersion",
      "One walk for four wavelengths, with refractive indices of the cuticle of 1.3, 1.43, 1.57 and 1.7 and "
      "absorption in the mesophyll in the ratio 1 : 2 : 3 : 4. Each wavelength is compared with the solver at 5, 60, "
      "89.5 and 140 degrees. Without absorption the weights of a wavelength have the mean 1."};
  for (const char* specimen : {"soybean", "maize"})
    for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
      for (const double depth : {0.0, 0.3}) add_dispersion(theme, specimen, depth, absorption);
  return theme;
}

}  // namespace frond::stability
