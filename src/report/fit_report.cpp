#include "report/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "report/share_tables.h"

namespace frond {
namespace {

using leaf::FittedNumber;
using leaf::LeafNumber;

/// A range of wavelengths by its usual name.
struct NamedBand {
  std::string_view name;
  Interval nm;
};
constexpr NamedBand kBands[] = {{"visible", {360, 700}},
                                {"red edge", {700, 760}},
                                {"near infrared", {760, 1300}},
                                {"short-wave infrared", {1300, 2500}}};
/// Correlation above which two parameters are reported as not separated.
constexpr double kGoTogether = 0.9;

/// Whether the leaf absorbs with PROSPECT-D's tables.
bool is_prospect(const leaf::FitResult& r) { return r.params.absorption_tables == leaf::AbsorptionTables::prospect; }

/// Returns all parameters that a scene file states; parameters of bifacial leaves are the last.
std::vector<const LeafNumber*> stated_numbers(const FitReport& report) {
  std::vector<const LeafNumber*> all;
  for (const bool only_bifacial : {false, true})
    for (const LeafNumber& n : leaf::leaf_parameters())
      if (n.only_bifacial == only_bifacial && n.changes_shares() && leaf::has_number(report.result.params.structure, n))
        all.push_back(&n);
  return all;
}

/// Returns the names of the parameters that the data do not determine.
std::vector<std::string> undetermined_parameters(const FitReport& report) {
  std::vector<std::string> names;
  for (const FittedNumber& n : report.result.numbers)
    if (!n.is_fixed && !n.is_identified()) names.emplace_back(n.variable->name);
  return names;
}

/// Returns a remark on an estimate; empty: none.
std::string estimate_note(const FittedNumber& n) {
  if (n.is_fixed) return "as given";
  if (n.is_at_bound) return "at a limit of its range: not determined by the data";
  if (n.is_of_prior) return "from the prior: not determined by the data";
  return n.is_identified() ? "" : "not determined by the data";
}

/// Whether the leaf's surface alone reflects more than was measured in the band.
bool is_below_surface_reflectance(const leaf::MisfitBand& band) { return !band.is_t && band.measured < band.lowest_r; }

/// Table of the bands that the fitted leaf misses.
std::string misfit_text(const FitReport& report) {
  const auto& misfits = report.result.misfits;
  if (misfits.empty()) return "";
  const bool one_angle = distinct(report.request.measurements, &leaf::LeafMeasurement::theta_deg).size() == 1;
  std::string text =
      fmt::format("  off by more than {:<19.2g}fitted  measured  lowest R with any absorption\n", leaf::kMisfit);
  for (const leaf::MisfitBand& band : misfits)
    text += fmt::format("    {} {:4.0f} to {:4.0f} nm {:<15}{:.4f}    {:.4f}    {}\n", band.is_t ? "T" : "R",
                        band.nm.min, band.nm.max, one_angle ? "" : fmt::format("at {:g} degrees", band.theta_deg),
                        band.fitted, band.measured, band.is_t ? "" : fmt::format("{:.4f}", band.lowest_r));
  return text;
}

/// Returns the errors as text: "RMSE 0.0059 (R 0.0056, T 0.0061)", without what was not measured.
std::string rmse_text(const leaf::FitResult& result) {
  std::vector<std::string> parts;
  if (result.rmse_r) parts.push_back(fmt::format("R {:.4f}", *result.rmse_r));
  if (result.rmse_t) parts.push_back(fmt::format("T {:.4f}", *result.rmse_t));
  return fmt::format("RMSE {:.4f} ({})", result.rmse, fmt::join(parts, ", "));
}

/// Returns the estimates in the order of the correlations.
std::vector<const FittedNumber*> free_numbers(const FitReport& report) {
  std::vector<const FittedNumber*> free;
  for (const FittedNumber& n : report.result.numbers)
    if (!n.is_fixed) free.push_back(&n);
  return free;
}

}  // namespace

std::string prior_text(const leaf::FitResult& result) {
  if (!result.prior) return "";
  return fmt::format("{} was not measured: the structure follows a prior, that of {}", result.rmse_r ? "T" : "R",
                     result.prior->source);
}

std::string fit_scene(const FitReport& report, const std::string& name) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("# Fitted to {} by frond fit: {}.\n", report.source, rmse_text(result));
  if (result.prior) text += fmt::format("# {}.\n", prior_text(result));
  if (const auto names = undetermined_parameters(report); !names.empty())
    text += fmt::format("# Not determined by the data, so no measurement: {}.\n", fmt::join(names, ", "));
  text += name.empty() ? fmt::format("Material \"{}\"", report.material)
                       : fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"{}\"", name, report.material);
  text += fmt::format(" \"string specimen\" \"{}\"\n", result.specimen->name);
  for (const LeafNumber* n : stated_numbers(report))
    text += fmt::format("    \"float {}\" {:.6g}\n", n->name, n->value(result.params));
  if (is_prospect(result)) text += "    \"string absorption\" \"prospect\"\n";
  if (result.params.sieve_and_detour) text += "    \"bool sieve\" true\n";
  return text;
}

std::string fitted_material_text(const FitReport& report, const std::string& material) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("{},specimen={}", material, result.specimen->name);
  for (const LeafNumber* n : stated_numbers(report))
    text += fmt::format(",{}={:.6g}", n->name, n->value(result.params));
  if (is_prospect(result)) text += ",absorption=prospect";
  if (result.params.sieve_and_detour) text += ",sieve=true";
  return text;
}

std::string number_line(std::string_view name, double value, std::string_view unit) {
  return fmt::format("  {:<20} {:>10.4g}{}{}\n", name, value, unit.empty() ? "" : " ", unit);
}

std::string plates_text(const leaf::PlateFit& plates) {
  std::string text = fmt::format("PROSPECT-D, fitted to the same R and T: RMSE {:.4f}\n", plates.rmse);
  for (size_t i = 0; i < leaf::plate_numbers().size(); ++i)
    text += number_line(leaf::plate_numbers()[i].name, plates.leaf.values[i], leaf::plate_numbers()[i].unit);
  return text;
}

std::string fit_text(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  std::string text =
      fmt::format("{}: {} measurements, {}\n", report.source, report.request.measurements.size(), rmse_text(result));
  for (const NamedBand& band : kBands)
    if (const auto rmse = leaf::rmse_between(report.request, result, band.nm))
      text += fmt::format("  {:<20} {:4.0f} to {:4.0f} nm   RMSE {:.4f}\n", band.name, band.nm.min, band.nm.max, *rmse);
  if (const auto far = std::ranges::count(result.fitted, true, &leaf::FitResult::Fitted::is_outlier); far > 0)
    text += fmt::format("  outliers (residual above 0.06, less weight): {}\n", far);
  text += misfit_text(report);
  if (report.request.background > 0)
    text += fmt::format("R is that of the leaf on a background of reflectance {:g}\n", report.request.background);
  if (result.prior) text += prior_text(result) + "\n";
  text += fmt::format("structure of {}, {} the sieve effect\n", result.specimen->name,
                      result.params.sieve_and_detour ? "with" : "without");
  for (const FittedNumber& n : result.numbers)
    text += fmt::format("  {:<20} {:>10.4g} {:<8}{}{}\n", n.variable->name, n.value, n.variable->unit,
                        n.is_identified() ? fmt::format("+- {:.2g} %", 100 * n.relative_error) : "", estimate_note(n));
  for (const LeafNumber& n : leaf::leaf_parameters())
    if (!n.follows.empty() && (n.value(result.params) > 0 || !n.only_with))
      text += fmt::format("  {} {:.4g} follows {}, which absorbs alike;\n", n.name, n.value(result.params), n.follows);
  text += fmt::format("  mesophyllfraction {:.4g} acts by its product with the thickness alone\n",
                      result.params.mesophyll_fraction);
  constexpr double kExact = 1e-9;  // relative error of a content that was given
  text += "per leaf area\n";
  for (const leaf::FittedContent& c : result.contents) {
    text += fmt::format("  {:<20} {:>10.4g} {:<8}{}\n", c.name, c.kg_per_m2 * c.unit.per_kg_per_m2, c.unit.name,
                        c.relative_error > kExact && c.relative_error < 0.5
                            ? fmt::format("+- {:.2g} %", 100 * c.relative_error)
                        : c.relative_error > kExact ? "not determined by the data"
                                                    : "as given");
  }
  if (report.plates) text += plates_text(*report.plates);
  const auto free = free_numbers(report);
  for (size_t a = 0; a < free.size(); ++a)
    for (size_t b = 0; b < a; ++b)
      if (std::abs(result.correlations[a][b]) > kGoTogether)
        text += fmt::format("  {} and {} are strongly correlated ({:.2f}): the data do not separate them\n",
                            free[b]->variable->name, free[a]->variable->name, result.correlations[a][b]);
  return text;
}

std::vector<Fact> fit_facts(const FitReport& report) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const leaf::FitResult& r = report.result;
  std::vector<Fact> facts{
      {"source", report.source},
      {"measurements", double(report.request.measurements.size())},
      {"rmse", r.rmse},
      {"rmse_R", r.rmse_r.value_or(kNone)},
      {"rmse_T", r.rmse_t.value_or(kNone)},
      {"specimen", std::string(r.specimen->name)},
      {"structure", std::string(r.params.structure == leaf::Structure::bifacial ? "bifacial" : "unifacial")},
      {"sieve", r.params.sieve_and_detour},
      {"absorption", std::string(is_prospect(r) ? "prospect" : "baranoski")},
      {"rmse_prospect", report.plates ? report.plates->rmse : kNone},
      {"background", report.request.background},
      {"prior", r.prior ? r.prior->source : ""}};
  if (r.prior) facts.insert(facts.end(), {{"prior_rmse", r.prior->error}, {"prior_reach_nm", r.prior->reach_nm}});
  return facts;
}

std::vector<Table> fit_tables(const FitReport& report) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const leaf::FitResult& result = report.result;
  Table spectra{"spectra"}, leaf{"leaf"}, numbers{"numbers"}, contents{"contents"}, bands{"bands"}, misfits{"misfits"},
      correlations{"correlations"};
  for (size_t i = 0; i < result.fitted.size(); ++i) {
    const leaf::LeafMeasurement& r = report.request.measurements[i];
    spectra.add("theta_deg", r.theta_deg);
    spectra.add("wavelength_nm", r.lambda_nm);
    spectra.add("R", r.r.value_or(kNone));
    spectra.add("T", r.t.value_or(kNone));
    spectra.add("R_fitted", result.fitted[i].r);
    spectra.add("T_fitted", result.fitted[i].t);
    spectra.add_flag("outlier", result.fitted[i].is_outlier);
  }
  for (const LeafNumber* n : stated_numbers(report))
    leaf.add("name", std::string(n->name)), leaf.add("value", n->value(result.params));
  for (const FittedNumber& n : result.numbers) {
    numbers.add("name", std::string(n.variable->name));
    numbers.add("value", n.value);
    numbers.add("unit", std::string(n.variable->unit));
    numbers.add("relative_standard_error", n.relative_error);
    numbers.add_flag("fixed", n.is_fixed);
    numbers.add_flag("at_bound", n.is_at_bound);
    numbers.add_flag("from_prior", n.is_of_prior);
    numbers.add_flag("identified", n.is_identified());
  }
  for (const leaf::FittedContent& c : result.contents) {
    contents.add("name", std::string(c.name));
    contents.add("value", c.kg_per_m2 * c.unit.per_kg_per_m2);
    contents.add("unit", std::string(c.unit.name));
    contents.add("relative_standard_error", c.relative_error);
  }
  for (const leaf::MisfitBand& band : result.misfits) {
    misfits.add("quantity", std::string(band.is_t ? "T" : "R"));
    misfits.add("theta_deg", band.theta_deg);
    misfits.add("from_nm", band.nm.min);
    misfits.add("to_nm", band.nm.max);
    misfits.add("measured", band.measured);
    misfits.add("fitted", band.fitted);
    misfits.add("lowest_R", band.lowest_r);
    misfits.add_flag("below_reach", is_below_surface_reflectance(band));
  }
  for (const NamedBand& band : kBands) {
    const auto rmse = leaf::rmse_between(report.request, result, band.nm);
    if (!rmse) continue;
    bands.add("name", std::string(band.name));
    bands.add("from_nm", band.nm.min);
    bands.add("to_nm", band.nm.max);
    bands.add("rmse", *rmse);
  }
  const auto free = free_numbers(report);
  for (size_t a = 0; a < free.size(); ++a) {
    correlations.add("name", std::string(free[a]->variable->name));
    for (size_t b = 0; b < free.size(); ++b)
      correlations.add(std::string(free[b]->variable->name), result.correlations[a][b]);
  }
  std::vector<Table> all{spectra, leaf, numbers, contents, bands, misfits, correlations};
  if (report.plates) {
    Table& prospect = all.emplace_back(Table{"prospect"});
    for (size_t i = 0; i < leaf::plate_numbers().size(); ++i) {
      prospect.add("name", std::string(leaf::plate_numbers()[i].name));
      prospect.add("value", report.plates->leaf.values[i]);
      prospect.add("unit", std::string(leaf::plate_numbers()[i].unit));
    }
  }
  if (!result.prior) return all;
  Table& prior = all.emplace_back(Table{"structure_prior"});
  // Coordinates, not parameters: their distributions are normal.
  for (size_t i = 0; i < leaf::prior_numbers().size(); ++i) {
    prior.add("name", std::string(leaf::prior_numbers()[i]->name));
    prior.add("mean", result.prior->mean[i]);
    prior.add("standard_deviation", result.prior->deviation[i]);
  }
  prior.document(
      "mean", "of the logarithm, that of otherabsorption times thickness and mesophyllfraction; of spongyshare itself");
  return all;
}

namespace {

/// Adds wide lines where a fitted curve is a misfit: to be covered by the curve.
void add_misfits(Panel& panel, const FitReport& report, bool is_t, const Series& fitted, double theta_deg) {
  for (const leaf::MisfitBand& band : report.result.misfits) {
    if (band.theta_deg != theta_deg || band.is_t != is_t) continue;
    Series wide = line("", "#f0b27a", 8);
    for (const ChartPoint& p : fitted.points)
      if (band.nm.contains(p.x)) wide.points.push_back(p);
    panel.series.push_back(wide);
  }
}

/// Adds the lowest R where it is above the measured R: to cover the curves. Bands of one wavelength are a mark.
void add_lowest(Panel& panel, const FitReport& report, double theta_deg) {
  for (const leaf::MisfitBand& band : report.result.misfits) {
    if (band.theta_deg != theta_deg || !is_below_surface_reflectance(band)) continue;
    panel.series.push_back({"",
                            kSeriesColors[2],
                            2,
                            Dash::dashed,
                            Mark::square,
                            2.5,
                            {{band.nm.min, band.lowest_r}, {band.nm.max, band.lowest_r}}});
  }
}

/// Returns entries of the legend for what is drawn without a label at its end.
std::vector<Series> legend_of(const FitReport& report) {
  std::vector<Series> entries{marks("measured", kSeriesColors[0], Mark::disk, 1.8)};
  const auto& misfits = report.result.misfits;
  if (!misfits.empty()) entries.push_back(line(fmt::format("off by more than {:.2g}", leaf::kMisfit), "#f0b27a", 8));
  if (std::ranges::any_of(misfits, is_below_surface_reflectance))
    entries.push_back(
        {"lowest R of this structure, with any absorption", kSeriesColors[2], 2, Dash::dashed, Mark::square, 2.5});
  return entries;
}

}  // namespace

Chart fit_chart(const FitReport& report) {
  const auto all = distinct(report.request.measurements, &leaf::LeafMeasurement::theta_deg);
  if (all.size() > kSeriesColors.size())
    fail({}, "--plot: {} angles are more than the {} distinguishable colours", all.size(), kSeriesColors.size());
  auto panels = shares_panels("wavelength (nm)");
  for (size_t a = 0; a < all.size(); ++a) {
    const char* color = kSeriesColors[(a + 1) % kSeriesColors.size()];
    Series fitted = line("", color, 2), r = fitted, t = fitted, of_r = marks("", kSeriesColors[0], series_mark(a), 1.8),
           of_t = of_r;
    r.end = t.end = all.size() == 1 ? "fitted" : fmt::format("fitted, {:.6g}°", all[a]);
    for (size_t i = 0; i < report.result.fitted.size(); ++i) {
      const leaf::LeafMeasurement& m = report.request.measurements[i];
      if (m.theta_deg != all[a]) continue;
      r.points.push_back({m.lambda_nm, report.result.fitted[i].r});
      t.points.push_back({m.lambda_nm, report.result.fitted[i].t});
      if (m.r) of_r.points.push_back({m.lambda_nm, *m.r});
      if (m.t) of_t.points.push_back({m.lambda_nm, *m.t});
    }
    for (Series* curve : {&r, &t}) std::ranges::stable_sort(curve->points, {}, &ChartPoint::x);
    add_misfits(panels[0], report, false, r, all[a]), add_misfits(panels[1], report, true, t, all[a]);
    panels[0].series.insert(panels[0].series.end(), {r, of_r}),
        panels[1].series.insert(panels[1].series.end(), {t, of_t});
    add_lowest(panels[0], report, all[a]);
  }
  set_range_of(panels);
  for (Series& entry : legend_of(report)) panels[0].series.push_back(std::move(entry));
  return {1, {panels[0], panels[1]}, fmt::format("{}: RMSE {:.4f}", report.source, report.result.rmse)};
}

}  // namespace frond
