#include "report/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/error.h"
#include "report/gnuplot.h"

namespace frond {
namespace {

using leaf::FittedNumber;
using leaf::TissueParams;

struct Band {
  std::string_view name;
  Interval nm;
};
constexpr Band kBands[] = {{"visible", {360, 700}},
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
  if (n.is_at_bound) return "at the end of its range: not determined by the data";
  return n.is_identified() ? "" : "not determined by the data";
}

std::vector<const FittedNumber*> free_numbers(const FitReport& report) {
  std::vector<const FittedNumber*> free;
  for (const FittedNumber& n : report.result.numbers)
    if (exists(report, n) && !n.is_fixed) free.push_back(&n);
  return free;
}

/// Angles of incidence, each once.
std::vector<double> angles(const FitReport& report) {
  std::vector<double> result;
  for (const leaf::LeafReading& r : report.request.readings)
    if (std::ranges::find(result, r.theta_deg) == result.end()) result.push_back(r.theta_deg);
  return result;
}

}  // namespace

std::string fit_scene(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("# Fitted to {} by frond fit: RMSE {:.4f} (R {:.4f}, T {:.4f}).\n", report.source,
                                 result.rmse, result.rmse_r, result.rmse_t);
  if (const auto names = not_told(report); !names.empty())
    text += fmt::format("# Not determined by the data, so no measurement: {}.\n", fmt::join(names, ", "));
  text += fmt::format("Material \"{}\" \"string specimen\" \"{}\"\n", report.material, result.specimen->name);
  for (const auto& [name, value] : said(report)) text += fmt::format("    \"float {}\" {:.6g}\n", name, value);
  if (result.params.sieve_and_detour) text += "    \"bool sieve\" true\n";
  return text;
}

std::string fit_text(const FitReport& report) {
  const leaf::FitResult& result = report.result;
  std::string text = fmt::format("{}: {} measurements, RMSE {:.4f} (R {:.4f}, T {:.4f})\n", report.source,
                                 report.request.readings.size(), result.rmse, result.rmse_r, result.rmse_t);
  for (const Band& band : kBands)
    if (const auto rmse = leaf::rmse_between(report.request, result, band.nm))
      text += fmt::format("  {:<20} {:4.0f} to {:4.0f} nm   RMSE {:.4f}\n", band.name, band.nm.min, band.nm.max, *rmse);
  if (const auto far = std::ranges::count(result.fitted, true, &leaf::FitResult::Fitted::is_outlier); far > 0)
    text += fmt::format("  {} measurements differ by more than 0.06 and have less weight\n", far);
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

std::vector<Fact> fit_facts(const FitReport& report) {
  const leaf::FitResult& r = report.result;
  return {{"source", report.source},
          {"measurements", double(report.request.readings.size())},
          {"rmse", r.rmse},
          {"rmse_R", r.rmse_r},
          {"rmse_T", r.rmse_t},
          {"specimen", std::string(r.specimen->name)},
          {"structure", std::string(r.params.structure == leaf::Structure::bifacial ? "bifacial" : "unifacial")},
          {"sieve", r.params.sieve_and_detour}};
}

std::vector<Table> fit_tables(const FitReport& report) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const leaf::FitResult& result = report.result;
  Table spectra{"spectra"}, leaf{"leaf"}, numbers{"numbers"}, bands{"bands"}, correlations{"correlations"};
  for (size_t i = 0; i < result.fitted.size(); ++i) {
    const leaf::LeafReading& r = report.request.readings[i];
    spectra.add("theta_deg", r.theta_deg);
    spectra.add("wavelength_nm", r.lambda_nm);
    spectra.add("R", r.r.value_or(kNone));
    spectra.add("T", r.t.value_or(kNone));
    spectra.add("R_fitted", result.fitted[i].r);
    spectra.add("T_fitted", result.fitted[i].t);
    spectra.add_flag("outlier", result.fitted[i].is_outlier);
  }
  for (const auto& [name, value] : said(report)) leaf.add("name", std::string(name)), leaf.add("value", value);
  for (const FittedNumber& n : result.numbers) {
    if (!exists(report, n)) continue;
    numbers.add("name", std::string(n.variable->name));
    numbers.add("value", n.value);
    numbers.add("relative_standard_error", n.relative_error);
    numbers.add_flag("fixed", n.is_fixed);
    numbers.add_flag("at_bound", n.is_at_bound);
    numbers.add_flag("identified", n.is_identified());
  }
  for (const Band& band : kBands) {
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
  return {spectra, leaf, numbers, bands, correlations};
}

std::string fit_chart(const FitReport& report) {
  const std::vector<double> all = angles(report);
  if (all.size() > kSeriesColors.size())
    fail({}, "--plot: {} angles are more than the {} colours that can be told apart", all.size(), kSeriesColors.size());
  std::string script, plots;
  for (size_t a = 0; a < all.size(); ++a) {
    std::map<double, std::string> lines;  // ascending
    for (size_t i = 0; i < report.result.fitted.size(); ++i) {
      const leaf::LeafReading& r = report.request.readings[i];
      if (r.theta_deg != all[a]) continue;
      const auto share = [](const std::optional<double>& x, bool from_above) {
        return x ? fmt::format("{:.6g}", from_above ? 1 - *x : *x) : std::string("NaN");
      };
      lines[r.lambda_nm] = fmt::format("{} {} {} {:.6f} {:.6f}\n", r.lambda_nm, share(r.r, false), share(r.t, true),
                                       report.result.fitted[i].r, 1 - report.result.fitted[i].t);
    }
    script += fmt::format("$d{} << EOD\n", a);
    for (const auto& [nm, line] : lines) script += line;
    script += "EOD\n";
    const std::string color = fmt::format("lc rgb '{}'", kSeriesColors[all.size() == 1 ? 1 : a]);
    const std::string of_angle = all.size() == 1 ? "" : fmt::format(" {:.6g}°", all[a]);
    plots += fmt::format(
        "$d{0} using 1:4 with lines lw 2 {1} title 'fitted{2}', $d{0} using 1:5 with lines lw 2 {1} notitle, "
        "$d{0} using 1:2 with points pt 7 ps 0.35 lc rgb '#000000' title 'measured{2}', "
        "$d{0} using 1:3 with points pt 7 ps 0.35 lc rgb '#000000' notitle, ",
        a, color, of_angle);
  }
  return script +
         "set yrange [0:1]\nset y2range [1:0]\nset ytics nomirror 0.1\nset y2tics 0.1\n"
         "set ylabel 'reflectance R (from below)'\nset y2label 'transmittance T (from above)'\n"
         "set xlabel 'wavelength (nm)'\nset autoscale xfix\nset grid lc rgb '#d0d0d0' lw 0.5\n" +
         fmt::format("set title {}\nset key center right\n",
                     gnuplot_text(fmt::format("{}: RMSE {:.4f}", report.source, report.result.rmse))) +
         "plot " + plots + "NaN notitle\n";
}

}  // namespace frond
