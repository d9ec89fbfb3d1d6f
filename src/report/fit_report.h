#pragma once

#include <string>

#include "leaf/fit/fit.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// A leaf that was fitted to measurements.
struct FitReport {
  const leaf::FitRequest& request;
  const leaf::FitResult& result;
  std::string source;    ///< the file with the measurements
  std::string material;  ///< plug-in of the Material line
};

/// A `Material` line of a scene file, with comments: its source, and the numbers that the data do not determine.
std::string fit_scene(const FitReport& report);
/// For a terminal: errors by band, the numbers with their errors, strong correlations, and what is not determined.
std::string fit_text(const FitReport& report);
/// Errors, and what is not a number of the leaf.
std::vector<Fact> fit_facts(const FitReport& report);
/// "spectra", "leaf", "numbers", "bands", "correlations".
std::vector<Table> fit_tables(const FitReport& report);
/// R from below, T from above; measured spectra as points, fitted ones as lines.
Chart fit_chart(const FitReport& report);

}  // namespace frond
