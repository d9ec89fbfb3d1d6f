#include "report/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "report/share_tables.h"

namespace frond {
namespace {

using leaf::FittedNumber;
using leaf::TissueParams;

struct NamedBand {
  std::string_view name;
  Interval nm;
};
constexpr NamedBand kBands[] = {{"visible", {360, 700}},
                                {"red edge", {700, 760}},
                                {"near infrared", {760, 1300}},
                                {"short-wave infrared", {1300, 2500}}};
constexpr double kGoTogether = 0.9;

/// All numbers of the leaf that a scene says, in its words.
struct Said {
  std::string_view name;
  double value;
};
std::vector<Said> said(const FitReport& report) {
  const TissueParams& p = report.result.params;
  std::vector<Said> all{{"thickness", p.thickness_m},
                        {"mesophyllfraction", p.mesophyll_fraction},
                        {"chlorophylla", p.chlorophyll_a},
                        {"chlorophyllb", p.chlorophyll_b},
                        {"carotenoids", p.carotenoids},
                        {"protein", p.protein},
                        {"cellulose", p.cellulose},
                        {"lignin", p.lignin},
                        {"otherabsorption", p.other_absorption},
                        {"epidermisaspect", p.epidermis_aspect},
                        {"spongyaspect", p.spongy_aspect}};
  if (p.structure == leaf::Structure::bifacial) all.push_back({"palisadeaspect", p.palisade_aspect});
  return all;
}

bool exists(const FitReport& report, const FittedNumber& number) {
  return report.result.params.structure == leaf::Structure::bifacial ||
         number.variable->number != &TissueParams::palisade_aspect;
}

std::vector<std::string> not_told(const FitReport& report) {
  std::vector<std::string> names;
  for (const FittedNumber& n : report.result.numbers)
    if (exists(report, n) && !n.is_fixed && !n.is_identified()) names.emplace_back(n.variable->name);
  return names;
}

std::string note(const FittedNumber& n) {
  if (n.is_fixed) return "as given";
  if (n.is_at_bound) return "at the end of its range: not told by the data";
  return n.is_identified() ? "" : "not told by the data";
}

std::vector<const FittedNumber*> free_numbers(const FitReport& report) {
  std::vector<const FittedNumber*> free;
  for (const FittedNumber& n : report.result.numbers)
    if (exists(report, n) && !n.is_fixed) free.push_back(&n);
  return free;
}

}  // namespace

std::string fit_scene(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("# Fitted to {} by frond fit: RMSE {:.4f} (R {:.4f}, T {:.4f}).\n", report.source,
                                 result.rmse, result.rmse_r, result.rmse_t);
  if (const auto names = not_told(report); !names.empty())
    text += fmt::format("# Not told by the data, so no measurement: {}.\n", fmt::join(names, ", "));
  text += fmt::format("Material \"{}\" \"string specimen\" \"{}\"\n", report.material, result.specimen->name);
  for (const auto& [name, value] : said(report)) text += fmt::format("    \"float {}\" {:.6g}\n", name, value);
  if (result.params.sieve_and_detour) text += "    \"bool sieve\" true\n";
  return text;
}

std::string fit_text(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("{}: {} readings, RMSE {:.4f} (R {:.4f}, T {:.4f})\n", report.source,
                                 report.request.readings.size(), result.rmse, result.rmse_r, result.rmse_t);
  for (const NamedBand& band : kBands)
    if (const auto rmse = leaf::rmse_between(report.request, result, band.nm))
      text += fmt::format("  {:<20} {:4.0f} to {:4.0f} nm   RMSE {:.4f}\n", band.name, band.nm.min, band.nm.max, *rmse);
  if (const auto far = std::ranges::count(result.fitted, true, &leaf::FitResult::Fitted::is_outlier); far > 0)
    text += fmt::format("  {} readings are further off than 0.06 and count for less\n", far);
  text += fmt::format("structure of {}, {} the sieve effect\n", result.specimen->name,
                      result.params.sieve_and_detour ? "with" : "without");
  for (const FittedNumber& n : result.numbers)
    if (exists(report, n))
      text += fmt::format("  {:<16} {:>10.4g}  {}{}\n", n.variable->name, n.value,
                          n.is_identified() ? fmt::format("+- {:.2g} %", 100 * n.relative_error) : "", note(n));
  text += fmt::format(
      "  chlorophyllb {:.4g} and lignin {:.4g} follow chlorophylla and cellulose, which absorb alike;\n"
      "  mesophyllfraction {:.4g} acts by its product with the thickness alone\n",
      result.params.chlorophyll_b, result.params.lignin, result.params.mesophyll_fraction);
  const auto free = free_numbers(report);
  for (size_t a = 0; a < free.size(); ++a)
    for (size_t b = 0; b < a; ++b)
      if (std::abs(result.correlations[a][b]) > kGoTogether)
        text += fmt::format("  {} and {} cannot be told apart well: their correlation is {:.2f}\n",
                            free[b]->variable->name, free[a]->variable->name, result.correlations[a][b]);
  return text;
}

std::string fit_json(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  nlohmann::ordered_json j{
      {"source", report.source},
      {"readings", report.request.readings.size()},
      {"rmse", result.rmse},
      {"rmse_R", result.rmse_r},
      {"rmse_T", result.rmse_t},
      {"specimen", result.specimen->name},
      {"structure", result.params.structure == leaf::Structure::bifacial ? "bifacial" : "unifacial"},
      {"sieve", result.params.sieve_and_detour}};
  for (const NamedBand& band : kBands)
    if (const auto rmse = leaf::rmse_between(report.request, result, band.nm))
      j["bands"].push_back({{"name", band.name}, {"from_nm", band.nm.min}, {"to_nm", band.nm.max}, {"rmse", *rmse}});
  for (const auto& [name, value] : said(report)) j["leaf"][name] = value;
  for (const FittedNumber& n : result.numbers)
    if (exists(report, n))
      j["numbers"].push_back({{"name", n.variable->name},
                              {"value", n.value},
                              {"relative_standard_error", n.relative_error},
                              {"fixed", n.is_fixed},
                              {"at_bound", n.is_at_bound},
                              {"identified", n.is_identified()}});
  for (const FittedNumber* n : free_numbers(report)) j["correlations"]["names"].push_back(n->variable->name);
  j["correlations"]["matrix"] = result.correlations;
  for (size_t i = 0; i < result.fitted.size(); ++i) {
    const leaf::LeafReading& reading = report.request.readings[i];
    nlohmann::ordered_json row{{"wavelength_nm", reading.lambda_nm}, {"theta_deg", reading.theta_deg}};
    row["R"] = reading.r ? nlohmann::ordered_json(*reading.r) : nlohmann::ordered_json();
    row["T"] = reading.t ? nlohmann::ordered_json(*reading.t) : nlohmann::ordered_json();
    row["R_fitted"] = result.fitted[i].r, row["T_fitted"] = result.fitted[i].t;
    row["outlier"] = result.fitted[i].is_outlier;
    j["spectra"].push_back(std::move(row));
  }
  return j.dump(1) + "\n";
}

std::string fit_csv(const FitReport& report) {
  std::string text =
      fmt::format("# {}, fitted by frond fit: RMSE {:.4f}\ntheta_deg,wavelength_nm,R,T,R_fitted,T_fitted\n",
                  report.source, report.result.rmse);
  const auto share = [](const std::optional<double>& x) { return x ? fmt::format("{:.6g}", *x) : std::string(); };
  for (size_t i = 0; i < report.result.fitted.size(); ++i) {
    const leaf::LeafReading& r = report.request.readings[i];
    text += fmt::format("{:.6g},{:.6g},{},{},{:.6f},{:.6f}\n", r.theta_deg, r.lambda_nm, share(r.r), share(r.t),
                        report.result.fitted[i].r, report.result.fitted[i].t);
  }
  return text;
}

Chart fit_chart(const FitReport& report) {
  const auto all = distinct(report.request.readings, &leaf::LeafReading::theta_deg);
  if (all.size() > kSeriesColors.size())
    fail({}, "--plot: {} angles are more than the {} colours that can be told apart", all.size(), kSeriesColors.size());
  Panel panel = shares_panel("wavelength (nm)");
  for (size_t a = 0; a < all.size(); ++a) {
    const std::string of_angle = all.size() == 1 ? "" : fmt::format(" {:.6g}°", all[a]);
    Series r = line("fitted" + of_angle, kSeriesColors[all.size() == 1 ? 1 : a], 2), t = line("", r.color, 2),
           measured = marks("measured" + of_angle, kSeriesColors[0], series_mark(a), 1.8);
    for (size_t i = 0; i < report.result.fitted.size(); ++i) {
      const leaf::LeafReading& m = report.request.readings[i];
      if (m.theta_deg != all[a]) continue;
      r.points.push_back({m.lambda_nm, report.result.fitted[i].r});
      t.points.push_back({m.lambda_nm, 1 - report.result.fitted[i].t});
      if (m.r) measured.points.push_back({m.lambda_nm, *m.r});
      if (m.t) measured.points.push_back({m.lambda_nm, 1 - *m.t});
    }
    for (Series* curve : {&r, &t}) std::ranges::stable_sort(curve->points, {}, &ChartPoint::x);
    panel.series.insert(panel.series.end(), {r, t, measured});
  }
  return {1, {panel}, fmt::format("{}: RMSE {:.4f}", report.source, report.result.rmse)};
}

}  // namespace frond
