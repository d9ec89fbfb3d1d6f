#include <limits>

#include "leaf/tissue/specimens.h"
#include "materials/leaf_params.h"
#include "tests/stability/cases.h"
#include "tests/stability/solved_f.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

using leaf::find_specimen;
using leaf::TissueParams;
using test::number;
using test::words;

using Number = const leaf::LeafNumber*;

Number known(std::string_view name) { return leaf::find_leaf_number(name); }

/// In the order of the materials' parameters.
std::vector<Number> all_numbers() {
  std::vector<Number> numbers;
  for (const Param& p : leaf_params())
    if (known(p.name)) numbers.push_back(known(p.name));
  return numbers;
}

/// Lobes of exponent 0 have an edge; those of 100 need more cells than the limit (docs/leaf_models.md).
constexpr double kEdgeOfF = 3e-3, kNarrowestF = 2e-3;

/// Bounds on the errors of the solver, of looking up its table, and of pi f of `leaf_solved`; 0: not compared.
struct Bounds {
  double solver = 1e-5, table = 5e-4, f = 0;
};

std::string expectation(const Bounds& b) {
  const std::string shares =
      fmt::format("exact; solver within {}, table within {}", rounded_up(b.solver), rounded_up(b.table));
  return b.f > 0 ? fmt::format("{}, pi f within {}", shares, rounded_up(b.f)) : shares;
}

void add_leaf(Theme& theme, std::string name, const TissueParams& params, double nm, Bounds bounds) {
  const leaf::TissueModel model(params);
  const leaf::Tissue tissue = model.at(nm);
  const Lit lit = solved_finely(tissue, {10, 75, 140});
  Row& row = theme.add(std::move(name), expectation(bounds));
  compare_tissue_methods(row, tissue, lit, bounds.solver);
  compare_material_methods(row, {params, nm}, lit, bounds.table);
  Specimen solved = solved_specimen({params, nm});
  compare_solved_leaf(row, solved, lit);
  if (bounds.f > 0) row.add(Method::solved_f, compare_solved_f(solved, tissue, {10, 40, 55, 75}, bounds.f));
}

/// Soybean with PROSPECT-D's absorption, instead of the published one.
void add_prospect_absorption(Theme& theme) {
  TissueParams params = find_specimen("soybean")->params;
  params.absorption_tables = leaf::AbsorptionTables::prospect;
  add_leaf(theme, "absorption \"prospect\"", params, 551, {});
}

/// Pigments change f only through the optical depth of the mesophyll, as thickness and fraction do.
bool shapes_f(std::string_view name) { return name == "thickness" || name == "mesophyllfraction"; }

bool is_aspect(std::string_view name) { return name.ends_with("aspect"); }

/// The wavelength at which the parameter has the largest effect.
double telling_nm(std::string_view name) {
  if (name == "protein" || name == "cellulose" || name == "lignin" || name == "drymatter") return 2100;
  return is_aspect(name) ? 800 : 551;
}

std::string value_text(const leaf::LeafNumber& p, double value) {
  return fmt::format("{} {:g}{}{}", p.name, value, p.unit.empty() ? "" : " ", p.unit);
}

void add_value(Theme& theme, Number n, double value, Bounds bounds = {}) {
  TissueParams params = find_specimen("soybean")->params;
  n->value(params) = value;
  add_leaf(theme, value_text(*n, value), params, telling_nm(n->name), bounds);
}

void add_aspects(Theme& theme, std::string_view specimen, double cuticle, double cells, Bounds bounds) {
  TissueParams params = find_specimen(specimen)->params;
  params.cuticle_aspect = cuticle;
  params.epidermis_aspect = params.spongy_aspect = params.palisade_aspect = cells;
  add_leaf(theme, fmt::format("{}, cuticle {:g}, all cells {:g}", specimen, cuticle, cells), params, 800, bounds);
}

/// One parameter value outside its range, for every leaf material.
void add_refusal(Theme& theme, std::string_view name, double value, const std::string& part) {
  Row& row = theme.add(fmt::format("{} {:g}", name, value), expect_refusal(part));
  const auto give_to = [&](std::string_view material) {
    return refusal(part, [&] { Specimen(material, {number("float", std::string(name), {value})}, 551); });
  };
  for (const auto& [method, material] : kLeafMaterials) row.add(method, give_to(material));
}

/// Each parameter in turn: the cell has the last message, or the first unexpected one.
Cell refuses_all(std::string_view material, double value, const std::string& part) {
  Cell cell;
  for (const Number n : all_numbers())
    if (!cell.is_surprise)
      cell = refusal(part, [&] { Specimen(material, {number("float", std::string(n->name), {value})}, 551); });
  return cell;
}

void add_no_number(Theme& theme, double value) {
  const std::string part = fmt::format("has the value {}, finite numbers are needed", value);
  Row& row = theme.add(fmt::format("each parameter {}", value), expect_refusal(part));
  for (const auto& [method, material] : kLeafMaterials) row.add(method, refuses_all(material, value, part));
}

/// A texture with values outside the range.
void add_texture(Theme& theme) {
  const std::string part = "has values from 3 to 300, outside the range 0 to 100 kg/m^3";
  const auto give_to = [&](std::string_view material) {
    return refusal(part, [&] { Specimen(material, {test::texture("chlorophylla", {"3:300"})}, 551); });
  };
  Row& row = theme.add("chlorophylla from a texture with values 3 to 300", expect_refusal(part));
  for (const auto& [method, material] : kLeafMaterials) row.add(method, give_to(material));
}

std::string range_text(const leaf::LeafNumber& p) {
  return fmt::format("outside its range {} to {}{}{}", p.range.min, p.range.max, p.unit.empty() ? "" : " ", p.unit);
}

/// Values just outside a range.
double just_below(const Interval& range) { return range.min == 0 ? -1e-9 : range.min * 0.999; }
double just_above(const Interval& range) { return range.max * 1.001; }

void add_oblateness(Theme& theme, double oblateness) {
  constexpr double kNm = 551;
  const leaf::TissueModel model(find_specimen("soybean")->params);
  const Lit lit = solved_finely(model.at(kNm), {0, 75, 89.9, 140});
  Specimen simplified("leaf_simplified", {number("float", "oblateness", {oblateness}), words("tablemethod", {"solve"})},
                      kNm);
  Comparison comparison(5e-4);
  for (size_t i = 0; i < lit.theta_deg.size(); ++i) {
    constexpr int kSamples = 20000;
    const MeasuredShares measured = sample_many(simplified.bsdf(), toward_in_float(lit.theta_deg[i]), kSamples);
    const leaf::Shares& truth = lit.truth[i];
    comparison.add("R + T", measured.all.estimate(), truth.surface + truth.subsurface + truth.transmitted, kSamples);
    comparison.add("T", measured.transmitted.estimate(), truth.transmitted, kSamples);
  }
  theme
      .add(fmt::format("oblateness {:g} of the surface lobe", oblateness),
           "R + T and T as without oblateness, within 5e-4")
      .add(Method::simplified, comparison.cell());
}

}  // namespace

Theme ends_of_ranges() {
  Theme theme{
      "Parameters at the ends of their ranges",
      "Rs, Rd and T at 10, 75 and 140 degrees against the solver with twice its nodes, at a wavelength that the "
      "parameter affects: 551 nm for pigments, 2100 nm for fibres, 800 nm for aspect ratios. All other parameters "
      "are those of soybean, or of maize if the case names it. pi f is compared if the parameter changes its shape "
      "and a solution with twice the nodes takes only a few seconds."};
  for (const Number n : all_numbers()) {
    if (is_aspect(n->name)) continue;
    const Interval range = n->range;
    const Bounds bounds{.f = shapes_f(n->name) ? kModesTolerance : 0};
    add_value(theme, n, range.min, bounds);
    if (range.min == 0) add_value(theme, n, 1e-12);
    add_value(theme, n, range.max, bounds);
  }
  add_prospect_absorption(theme);
  for (const double cuticle : {0.0, 0.2, 5.0, 1000.0})
    add_value(theme, known("cuticleaspect"), cuticle, {.f = kModesTolerance});
  const Bounds edge{5e-4, 2e-3, kEdgeOfF}, narrow{1e-5, 2e-3}, narrow_with_f{1e-5, 2e-3, kNarrowestF};
  for (const Number n : {known("epidermisaspect"), known("spongyaspect"), known("palisadeaspect")}) {
    add_value(theme, n, 0, edge);
    add_value(theme, n, 100, n->name == "epidermisaspect" ? narrow_with_f : narrow);
  }
  for (const char* specimen : {"soybean", "maize"}) {
    add_aspects(theme, specimen, 0, 0, {5e-4, 1e-3, kEdgeOfF});
    add_aspects(theme, specimen, 1000, 100, {1e-5, 5e-3});
  }
  for (const double oblateness : {0.0, 0.2, 5.0, 1000.0}) add_oblateness(theme, oblateness);
  return theme;
}

Theme outside_ranges() {
  Theme theme{"Parameters outside their ranges",
              "Every leaf material with values just outside each end of a range, and with NaN and infinity."};
  for (const Number n : all_numbers()) {
    add_refusal(theme, n->name, just_below(n->range), range_text(*n));
    add_refusal(theme, n->name, just_above(n->range), range_text(*n));
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinite, -kInfinite})
    add_no_number(theme, value);
  add_texture(theme);
  for (const double oblateness : {-0.5, 1001.0}) {
    const std::string part = "outside its range 0 to 1000";
    theme.add(fmt::format("oblateness {}", oblateness), expect_refusal(part))
        .add(Method::simplified,
             refusal(part, [&] { Specimen("leaf_simplified", {number("float", "oblateness", {oblateness})}, 551); }));
  }
  return theme;
}

}  // namespace frond::stability
