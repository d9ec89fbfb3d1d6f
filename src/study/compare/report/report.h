#pragma once

#include <filesystem>

#include "study/compare/report/data_files.h"

namespace frond::compare {

/// Throws InputError if the folder cannot be created or written. Leaves no files.
void check_report_folder(const std::filesystem::path& folder);

/// Creates the folder and writes index.html, which is self-contained, the charts as SVG (also PNG if librsvg is
/// available), and the data as CSV and JSON.
void write_report(const std::filesystem::path& folder, const Comparison& comparison, const ComparisonData& data);

}  // namespace frond::compare
