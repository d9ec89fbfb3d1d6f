#pragma once

#include <string>
#include <vector>

#include "leaf/fit/fit.h"
#include "leaf/plates/plate_leaf.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// Result of a fit of leaf parameters, with its source.
struct FitReport {
  const leaf::FitRequest& request;
  const leaf::FitResult& result;
  std::string source;                         ///< name of the file with the measurements
  std::string material;                       ///< plug-in of the Material directive
  std::optional<leaf::PlateFit> plates = {};  ///< PROSPECT's numbers for the same measurements
};

/// Returns a `Material` directive with comments: the source, and the parameters that the data do not determine. With a
/// name, a `MakeNamedMaterial` directive.
std::string fit_scene(const FitReport& report, const std::string& name = {});
/// Returns the fitted leaf as text such as `leaf_solved,specimen=maize,thickness=2e-4`.
std::string fitted_material_text(const FitReport& report, const std::string& material);
/// Returns text for a terminal: errors by band, parameters with errors, strong correlations, undetermined parameters.
std::string fit_text(const FitReport& report);
/// Returns errors, and results that are not parameters of the leaf.
std::vector<Fact> fit_facts(const FitReport& report);
/// Returns the tables "spectra", "leaf", "numbers", "contents", "bands", "misfits", "correlations", and
/// "structure_prior" if there is one.
std::vector<Table> fit_tables(const FitReport& report);
/// Returns the structure prior of a fit in words: "T was not measured: ..."; empty: there is none.
std::string prior_text(const leaf::FitResult& result);
/// Returns a number of a leaf as a line of text.
std::string number_line(std::string_view name, double value, std::string_view unit);
/// Returns PROSPECT's numbers as such lines.
std::string plates_text(const leaf::PlateFit& plates);
/// Returns a chart of R from below and T from above: measured spectra as points, fitted spectra as lines.
Chart fit_chart(const FitReport& report);

/// One leaf of a fit of many.
struct LeafFitReport {
  std::string file;        ///< name of the file; empty: none
  std::string leaf;        ///< its name
  std::string error = {};  ///< why it was not fitted; empty: it was
  size_t measurements = 0;
  leaf::FitRequest request = {};  ///< what was fitted; may lack the measurements
  leaf::FitResult result = {};    ///< only without `error`
  std::optional<leaf::PlateFit> plates = {};
};

/// Returns the table "leaves", a row for each leaf: file, leaf, status, errors, kind, parameters and contents with
/// their standard errors. `tables`: absorption of all of the fits, which determines the columns.
Table leaves_table(const std::vector<LeafFitReport>& leaves, leaf::AbsorptionTables tables);
/// Returns numbers of leaves and the median and largest RMSE.
std::vector<Fact> leaves_facts(const std::vector<LeafFitReport>& leaves);
/// Returns text for a terminal: these facts, and the first leaves that failed.
std::string leaves_text(const std::vector<LeafFitReport>& leaves);
/// Returns `MakeNamedMaterial` directives of all fitted leaves, by their names; a name that several files have is
/// preceded by the file's. The last one, "all leaves", is one of them for each instance, by the column `leaf` of a
/// table of instances.
std::string leaves_scene(const std::vector<LeafFitReport>& leaves, const std::string& material);
/// Returns a specimen file of the fitted leaves and their mean, with the standard deviations of the logarithms of their
/// parameters as a comment.
std::string specimens_csv(const std::vector<LeafFitReport>& leaves, const LeafFitReport& mean,
                          leaf::AbsorptionTables tables);

}  // namespace frond
