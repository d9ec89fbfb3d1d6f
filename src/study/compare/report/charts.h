#pragma once

#include "report/chart.h"
#include "study/compare/comparison.h"

namespace frond::compare {

/// The largest number of candidates in one chart, limited by distinguishable colours.
inline constexpr size_t kMostCurves = kSeriesColors.size();

/// Quantity of a chart against CPU time.
enum class Measure : uint8_t { rms_all, rms_leaf, flip };

/// Returns a chart of error against CPU time, both logarithmic: one curve with 95 % intervals for each candidate, and
/// the Pareto frontier. RMS charts show each candidate's bias and where noise falls below it. Returns nullopt if no
/// candidate has an error above 0.
std::optional<Chart> curves_chart(const Comparison& comparison, Measure measure);

/// Returns a chart of bias (with 95 % intervals) and noise of one render after the last run against the bands'
/// wavelengths, over all pixels. Returns nullopt if there are none. For comparisons of bands.
std::optional<Chart> bands_chart(const Comparison& comparison);

/// One chart of a report.
struct ReportChart {
  std::string name;         ///< base name of its files
  std::string description;  ///< alternative text
  std::string caption;
  std::optional<Chart> chart;  ///< empty: there is nothing to draw
};

/// Returns the charts of a report: error against time over all pixels and over leaves; then FLIP against time, or for
/// bands error against wavelength.
std::vector<ReportChart> charts_of(const Comparison& comparison);

}  // namespace frond::compare
