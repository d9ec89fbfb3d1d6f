#pragma once

#include <string>

#include "leaf/fit/fit.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// Result of a fit of leaf parameters, with its source.
struct FitReport {
  const leaf::FitRequest& request;
  const leaf::FitResult& result;
  std::string source;    ///< name of the file with the measurements
  std::string material;  ///< plug-in of the Material directive
};

/// Returns a `Material` directive with comments: the source, and the parameters that the data do not determine.
std::string fit_scene(const FitReport& report);
/// Returns text for a terminal: errors by band, parameters with errors, strong correlations, undetermined parameters.
std::string fit_text(const FitReport& report);
/// Returns errors, and results that are not parameters of the leaf.
std::vector<Fact> fit_facts(const FitReport& report);
/// Returns the tables "spectra", "leaf", "numbers", "contents", "bands", "misfits", "correlations".
std::vector<Table> fit_tables(const FitReport& report);
/// Returns a chart of R from below and T from above: measured spectra as points, fitted spectra as lines.
Chart fit_chart(const FitReport& report);

}  // namespace frond
