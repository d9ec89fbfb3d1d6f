#include <boost/math/special_functions/expint.hpp>

#include "instruments/spectrophotometer.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/specimens.h"
#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"
#include "tests/support/input_error.h"

namespace frond::stability {
namespace {

using leaf::Absorption;
using leaf::find_specimen;
using leaf::Tissue;
using leaf::TissueModel;
using leaf::TissueParams;
using test::number;
using test::words;

const std::vector<double> kAngles{10, 75, 89.99, 140};

/// Every ray keeps its energy, not only their mean.
Cell walks_lose_nothing(const Tissue& tissue, Absorption absorption) {
  Comparison comparison;
  for (const double theta_deg : kAngles) {
    const Estimate all = walk_many(tissue, theta_deg, absorption, 4000).all.estimate();
    comparison.add("Rs + Rd + T", all.mean, 1);
    comparison.require(all.variance < 1e-24, "a ray lost light");
  }
  return comparison.cell();
}

Cell batches_lose_nothing(const Tissue& tissue) {
  Comparison comparison;
  for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
    for (const double theta_deg : kAngles)
      comparison.add("Rs + Rd + T", walk_many_in_batch(tissue, theta_deg, absorption, 20000).all.mean(), 1);
  return comparison.cell();
}

Cell solver_loses_nothing(const Tissue& tissue, double bound) {
  Comparison comparison(bound);
  for (const leaf::Shares& s : leaf::solve(tissue, kAngles))
    comparison.add("Rs + Rd + T", s.surface + s.subsurface + s.transmitted, 1);
  return comparison.cell();
}

Cell material_loses_nothing(const std::string& material, const Parameters& params, double bound) {
  Specimen specimen(material, params, 800);
  Comparison comparison(bound);
  for (const double theta_deg : kAngles)
    comparison.add("Rs + Rd + T", sample_many(specimen.bsdf(), toward_in_float(theta_deg), 2000).all.mean(), 1);
  return comparison.cell();
}

Cell integral_loses_nothing(const Specimen& solved) {
  Comparison comparison(kModesTolerance);
  for (const double theta_deg : kAngles) {
    const leaf::Shares s = integrate_shares(solved, theta_deg);
    comparison.add("R + T", s.subsurface + s.transmitted, 1);
  }
  return comparison.cell();
}

/// For each value of "incident", light from one direction.
Cell instruments_lose_nothing(const Parameters& params) {
  Comparison comparison(2e-6);
  for (const char* material : {"abm", "leaf_simplified"})
    for (const char* incident : {"traced", "light"}) {
      Parameters all = params;
      all.push_back(words("incident", {incident}));
      Specimen specimen(material, all, 800);
      for (const double theta_deg : kAngles) {
        constexpr int64_t kRays = 10000;
        const auto measurement = measure_shares({specimen.material(), {theta_deg, 800}}, {kRays}, specimen.pool());
        const Estimate &r = measurement.reflectance, &t = measurement.transmittance;
        comparison.add("R + T", Estimate{r.mean + t.mean, measurement.absorptance.variance}, 1, kRays);
      }
    }
  return comparison.cell();
}

/// R + T = 1, and each share equal to that of a solution with twice the nodes.
void add_lossless(Theme& theme, const std::string& name, TissueParams params) {
  params.mesophyll_fraction = 0;
  const TissueModel model(params);
  const Tissue tissue = model.at(800);
  constexpr double kFloat = 2e-6;
  Parameters solved = words_for(params), walked = solved;
  solved.push_back(words("tablemethod", {"solve"}));
  walked.push_back(words("tablemethod", {"montecarlo"}));
  walked.push_back(number("integer", "tablerays", {100}));
  const Specimen solved_leaf = solved_specimen({params, 800});
  theme
      .add(name + ": energy",
           "R + T = 1: for each ray in double precision; within 2e-6 in single precision; mode table within 5e-4; for "
           "every incident")
      .add(Method::walk_analog, walks_lose_nothing(tissue, Absorption::analog))
      .add(Method::walk_weighted, walks_lose_nothing(tissue, Absorption::weighted))
      .add(Method::batch, batches_lose_nothing(tissue))
      .add(Method::solver, solver_loses_nothing(tissue, 1e-9))
      .add(Method::abm, material_loses_nothing("abm", words_for(params), kFloat))
      .add(Method::simplified, material_loses_nothing("leaf_simplified", solved, kFloat))
      .add(Method::solved_leaf, integral_loses_nothing(solved_leaf))
      .add(Method::lambert, material_loses_nothing("leaf_lambert", words_for(params), kFloat))
      .add(Method::spectrophotometer, instruments_lose_nothing(words_for(params)))
      .add(Method::simplified_walked, material_loses_nothing("leaf_simplified", walked, kFloat));
  Row& shares = theme.add(name + ": shares", "exact; solver within 2e-5, table within 5e-4");
  const Lit lit = solved_finely(tissue, kAngles);
  compare_tissue_methods(shares, tissue, lit, 2e-5);
  compare_material_methods(shares, {params, 800}, lit, 5e-4);
  compare_solved_leaf(shares, solved_leaf, lit);
}

/// Cases of an opaque mesophyll.
void add_opaque(Theme& theme, const std::string& name, const LeafInScene& leaf, const TissueParams& tissue_params) {
  const TissueModel model(tissue_params);
  const Tissue tissue = model.at(leaf.lambda_nm);
  Lit lit = solved_finely(tissue, kAngles);
  for (leaf::Shares& s : lit.truth) s.transmitted = 0;
  Row& row = theme.add(name, "T = 0, R only of surface and epidermis; solver within 1e-5, table within 5e-4");
  compare_tissue_methods(row, tissue, lit, 1e-5);
  compare_material_methods(row, leaf, lit, 5e-4);
  compare_solved_leaf(row, solved_specimen(leaf), lit);
}

/// A pigment that absorbs `level` m^2/kg at all wavelengths.
void add_pigment(Theme& theme, std::string_view specimen, double level) {
  const TestFolder folder("stability");
  const auto file = folder.write("black.spd", fmt::format("300 {0}\n3000 {0}\n", level));
  const TissueParams& base = find_specimen(specimen)->params;
  TissueParams with = base;
  with.pigments.push_back({100, std::vector<double>(leaf::kAbsorptionGrid.size(), level)});
  const LeafInScene leaf{
      base, 800, {words("pigments", {file.string()}), number("float", "pigmentconcentrations", {100})}};
  add_opaque(theme, fmt::format("{}, 100 kg/m^3 of a pigment of {:g} m^2/kg", specimen, level), leaf, with);
}

void add_bad_pigment(Theme& theme, const std::string& name, std::string_view text, const std::string& part) {
  const TestFolder folder("stability");
  const auto file = folder.write("pigment.spd", text);
  const Parameters params{words("pigments", {file.string()}), number("float", "pigmentconcentrations", {1})};
  const auto give_to = [&](std::string_view material) {
    return refusal(
        part, [&] { Specimen(material, params, 800); }, folder.name_of(""));
  };
  Row& row = theme.add("a pigment " + name, expect_refusal(part));
  for (const auto& [method, material] : kLeafMaterials) row.add(method, give_to(material));
}

/// Media with equal indices, a lobe at the entrance and absorption: light is attenuated by Beer's law without
/// scattering.
void add_beer(Theme& theme, double exponent, double depth) {
  const leaf::Lobe lobe(exponent);
  Tissue tissue{};
  tissue.n.fill(1);
  tissue.optical_depth[2] = depth;
  leaf::InterfaceLobes lobes{};
  lobes[0][0] = {&lobe, &lobe};
  lobes[5][1] = {&lobe, &lobe};
  tissue.lobes = &lobes;
  // The mean of exp(-depth / c) over the lobe's (e + 1) c^e is an exponential integral.
  const double t = (exponent + 1) * boost::math::expint(static_cast<unsigned>(exponent) + 2, depth);
  const Lit lit{{0, 180}, {{0, 0, t}, {0, 0, t}}};
  const double bound = exponent > 0 ? 1e-5 : 5e-5;
  Row& row =
      theme.add(fmt::format("equal indices, optical depth {:g}, entrance lobe of exponent {:g}", depth, exponent),
                fmt::format("T = (e + 1) E(e + 2, depth), R = 0; solver within {}", rounded_up(bound)));
  compare_tissue_methods(row, tissue, lit, bound);
}

}  // namespace

Theme absorption() {
  Theme theme{
      "No absorption and complete absorption",
      "At 10, 75, 89.99 and 140 degrees and 800 nm, against 1, against 0, against Beer's law in closed form, and "
      "against the solver with twice its nodes. Without absorption the length of a walk is not limited."};
  for (const leaf::Specimen& s : std::span(leaf::kSpecimens).first(2)) {
    add_lossless(theme, fmt::format("{}, no absorption", s.name), s.params);
    TissueParams narrow = s.params;
    narrow.cuticle_aspect = 1000;
    narrow.epidermis_aspect = narrow.spongy_aspect = narrow.palisade_aspect = 100;
    add_lossless(theme, fmt::format("{}, no absorption, narrowest lobes", s.name), narrow);
    for (const double level : {1e6, 1e30}) add_pigment(theme, s.name, level);
  }
  add_bad_pigment(theme, "of negative absorption", "300 1\n3000 -1\n", "negative");
  add_bad_pigment(theme, "of absorption NaN", "300 1\n3000 nan\n", "nan");
  add_bad_pigment(theme, "defined up to 700 nm, at 800 nm", "300 1\n700 1\n",
                  "from 300 to 700 nm, 800 nm was asked for");
  for (const double exponent : {0.0, 1.0, 5.0})
    for (const double depth : {0.01, 1.0}) add_beer(theme, exponent, depth);
  return theme;
}

}  // namespace frond::stability
