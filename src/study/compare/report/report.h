#pragma once

#include <filesystem>

#include "study/compare/report/data_files.h"

namespace frond::compare {

/// Refuses, by InputError, a folder that cannot be made or written to. Leaves nothing behind.
void check_report_folder(const std::filesystem::path& folder);

/// Makes the folder and writes index.html, which needs nothing beside it, the charts as SVG (and PNG where there
/// is librsvg), and the data as CSV and JSON.
void write_report(const std::filesystem::path& folder, const Comparison& comparison, const ComparisonData& data);

}  // namespace frond::compare
