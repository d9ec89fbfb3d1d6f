#pragma once

#include "report/chart.h"
#include "study/compare/comparison.h"

namespace frond::compare {

/// The most candidates that one chart can tell apart.
inline constexpr size_t kMostCurves = kSeriesColors.size();

/// What is drawn against CPU time.
enum class Measure : uint8_t { rms_all, rms_leaf, flip };

/// Error against CPU time, both logarithmic, one curve for each candidate with 95 % intervals, the Pareto frontier
/// behind them; RMS charts show each candidate's bias and from when on noise is below it. None where no candidate made
/// an error that a logarithmic axis can show.
std::optional<Chart> curves_chart(const Comparison& comparison, Measure measure);

/// Bias with 95 % intervals, and noise of one render after the last run, against the bands' wavelengths, over all
/// pixels. None where no band has any. For comparisons of bands.
std::optional<Chart> bands_chart(const Comparison& comparison);

/// One chart of a report.
struct ReportChart {
  std::string name;         ///< of its files, without the ending
  std::string description;  ///< for those who do not see it
  std::string caption;
  std::optional<Chart> chart;  ///< none: there is nothing to draw
};

/// Error against time over all pixels and over leaves; then FLIP against time, or of bands error against wavelength.
std::vector<ReportChart> charts_of(const Comparison& comparison);

}  // namespace frond::compare
