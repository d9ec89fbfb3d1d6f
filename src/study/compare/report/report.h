#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/compare/report/data_files.h"

namespace frond::compare {

/// Returns the names of all files that a report may have.
std::vector<std::string> report_files();

/// Throws InputError if the folder, or a file of the report in it, cannot be written. Leaves no files.
void check_report_folder(const std::filesystem::path& folder);

/// Writes all or nothing: index.html, which is self-contained, the charts as SVG (also PNG if librsvg is available),
/// and the data as CSV and JSON. Creates the folder if necessary.
void write_report(const std::filesystem::path& folder, const Comparison& comparison, const ComparisonData& data);

}  // namespace frond::compare
