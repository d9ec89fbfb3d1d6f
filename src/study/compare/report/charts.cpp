#include "study/compare/report/charts.h"

#include <fmt/format.h>

#include "study/compare/error_unit.h"

namespace frond::compare {
namespace {

/// Returns an empty series with the candidate's colour, dash and mark, and its label at the end.
Series candidate_series(size_t candidate, std::string label) {
  constexpr size_t kSolid = 4;
  const Dash dash = candidate < kSolid ? Dash::solid : Dash::dashed;
  Series s{"", kSeriesColors[candidate], 2, dash, series_mark(candidate)};
  s.end = std::move(label);
  return s;
}

/// Returns points of CPU seconds and error in the axis's unit, with intervals. Points that a logarithmic axis cannot
/// show are omitted.
std::vector<ChartPoint> points_of(const CandidateResult& measured, Measure measure, const ErrorUnit& unit) {
  std::vector<ChartPoint> points;
  for (const CandidateRun& run : measured.runs) {
    const MeanSquare& e = run.errors[measure == Measure::rms_leaf ? kLeaf : kAll][kTogether].total;
    ChartPoint p{run.cost.cpu_seconds, run.flip.value_or(0)};
    if (measure != Measure::flip)
      p.y = unit.axis_value(e.root()), p.bar = {unit.axis_value(e.root_at(-kZ95)), unit.axis_value(e.root_at(kZ95))};
    if (p.x > 0 && p.y > 0) points.push_back(p);
  }
  return points;
}

Series frontier(const std::vector<Series>& curves) {
  std::vector<CostAndError> all;
  for (const Series& curve : curves)
    for (const ChartPoint& p : curve.points) all.push_back({p.x, p.y});
  Series s = line("smallest error for the time (Pareto frontier)", "#d9d9d9", 9);
  for (const size_t i : pareto_frontier(all)) s.points.push_back({all[i].cost, all[i].error});
  return s;
}

/// Returns the bias and the time at which noise falls below it; nullopt without bias.
std::optional<ChartPoint> plateau_of(const CandidateResult& measured, Measure measure) {
  if (measure == Measure::flip) return {};
  const Convergence c = measured.convergence(measure == Measure::rms_leaf ? kLeaf : kAll);
  if (const auto effort = c.until_plateau()) return ChartPoint{effort->seconds, c.bias().root()};
  return {};
}

/// Returns the bands' interval of wavelengths.
Interval range_nm(const ChannelList& channels) {
  const auto [least, most] = std::ranges::minmax(channels.bands, {}, &Band::nm);
  return {least.nm, most.nm};
}

double mean_step_nm(const ChannelList& channels) {
  const Interval range = range_nm(channels);
  return range.min < range.max ? (range.max - range.min) / double(channels.bands.size() - 1) : 10;
}

/// Returns the bias in the axis's unit with its 95 % interval; NaN if it is not above 0 with 97.5 % confidence.
ChartPoint bias_point(double nm, const MeanSquare& bias, const ErrorUnit& unit) {
  const Range bar{unit.axis_value(bias.root_at(-kZ95)), unit.axis_value(bias.root_at(kZ95))};
  return {nm, bar.low > 0 ? unit.axis_value(bias.root()) : NAN, bar};
}

std::string rms_caption(const Comparison& c) {
  return fmt::format(
      "One point for each doubling of samples per pixel, from {} to {}; bars are 95 % intervals. Error is against what "
      "the reference converges to: its noise, {}, is taken out. A cross and the dotted line after it: from there "
      "on noise is below the candidate’s bias, and more samples help little. A candidate without a cross has no "
      "significant bias.",
      c.candidates.front().runs.front().samples, c.candidates.front().runs.back().samples,
      c.request.error_unit().rounded(c.reference.noise[kAll][kTogether].root()));
}

std::string flip_caption(const Comparison& c) {
  return fmt::format(
      "What a person would see who flips between a render and the reference (Andersson et al. 2020, 67 pixels per "
      "degree, exposure {:+g} stops); 0: nothing, 1: all. The reference’s two renders differ by {:.2g}.",
      c.exposure_stops, c.reference.flip.value_or(0));
}

constexpr const char* kBandsCaption =
    "All pixels. Points: bias, with bars of 95 %. A bar without a point: no significant bias; it is at most the "
    "bar’s upper end. Dotted: the noise that is left.";

}  // namespace

std::optional<Chart> curves_chart(const Comparison& c, Measure measure) {
  const ErrorUnit unit = c.request.error_unit();
  Range x, y;
  std::vector<Series> curves, plateaus;
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    Series& s = curves.emplace_back(candidate_series(i, c.candidates[i].candidate.label));
    s.points = points_of(c.candidates[i], measure, unit);
    for (const ChartPoint& p : s.points) x.include(p.x), y.include(p.y);
    auto plateau = plateau_of(c.candidates[i], measure);
    if (!plateau) continue;
    const std::string end =
        fmt::format("{}\nbias {}, from {} s on", s.end, unit.rounded(plateau->y), figures(plateau->x, 2));
    s.end.clear();
    plateau->y = unit.axis_value(plateau->y);
    x.include(plateau->x), y.include(plateau->y);
    // A cross, and a dotted line to the label.
    plateaus.push_back(marks("", s.color, Mark::cross, 5.5, {*plateau}));
    plateaus.push_back(line("", s.color, 2, Dash::dotted, {*plateau, {1e300, plateau->y}}));
    plateaus.back().end = end;
  }
  std::vector<Series> all{frontier(curves)};
  if (all[0].points.empty()) return {};
  all.insert(all.end(), curves.begin(), curves.end()), all.insert(all.end(), plateaus.begin(), plateaus.end());
  const std::string pixels = measure == Measure::rms_leaf ? "leaf" : "all", unit_text = unit.axis_unit(c.channels),
                    time = fmt::format("CPU time of one {} × {} render (s)", c.width, c.height),
                    error = measure == Measure::flip ? "mean FLIP"
                                                     : fmt::format("RMS error, {} pixels ({})", pixels, unit_text);
  return Chart{1, {{900, 520, "", {time, x.widened(), true}, {error, y.widened(), true}, false, all}}};
}

std::optional<Chart> bands_chart(const Comparison& c) {
  const ErrorUnit unit = c.request.error_unit();
  const double step_nm = mean_step_nm(c.channels);
  const auto& bands = c.channels.bands;
  std::vector<Series> series;
  Range y;
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    // Offset that separates the candidates' error bars.
    const double aside = step_nm * 0.5 * ((double(i) + 0.5) / double(c.candidates.size()) - 0.5);
    Series noise = line("", kSeriesColors[i], 2, Dash::dotted),
           bias = candidate_series(i, c.candidates[i].candidate.label);
    for (size_t b = 0; b < bands.size(); ++b) {
      const RenderError& e = c.candidates[i].runs.back().errors[kAll][kFirst + b];
      noise.points.push_back({bands[b].nm, unit.axis_value(e.noise.root())});
      bias.points.push_back(bias_point(bands[b].nm + aside, e.bias, unit));
      for (const double v : {noise.points.back().y, bias.points.back().bar.low, bias.points.back().bar.high})
        if (v > 0) y.include(v);
    }
    for (Series* by_wavelength : {&noise, &bias}) std::ranges::stable_sort(by_wavelength->points, {}, &ChartPoint::x);
    series.insert(series.end(), {noise, bias});
  }
  if (y.is_empty()) return {};
  y = Range{std::max(y.low, y.high / 1e4), y.high}.widened();
  series.push_back(marks("bars: 95 % intervals; without a mark the bias is not significant", "#000000", Mark::bar, 5));
  const uint64_t samples = c.candidates[0].runs.back().samples;
  series.push_back(line(fmt::format("noise of one render of {} samples", samples), "#000000", 2, Dash::dotted));
  const Interval all = range_nm(c.channels);
  const Range nm{all.min - step_nm, all.max + step_nm};
  const std::string error = fmt::format("bias and noise ({})", unit.axis_unit(c.channels));
  return Chart{1, {{900, 520, "", {"wavelength (nm)", nm}, {error, y, true}, false, series}}};
}

std::vector<ReportChart> charts_of(const Comparison& c) {
  std::vector<ReportChart> charts{
      {"rms", "RMS error against CPU time, all pixels", rms_caption(c), curves_chart(c, Measure::rms_all)},
      {"rms-leaf", "RMS error against CPU time, leaf pixels", "The same over the pixels that see a leaf.",
       curves_chart(c, Measure::rms_leaf)}};
  if (c.channels.are_bands())
    charts.push_back({"bands", "Bias and noise against wavelength", kBandsCaption, bands_chart(c)});
  else
    charts.push_back({"flip", "FLIP against CPU time", flip_caption(c), curves_chart(c, Measure::flip)});
  return charts;
}

}  // namespace frond::compare
