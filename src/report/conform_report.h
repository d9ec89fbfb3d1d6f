#pragma once

#include <string>
#include <vector>

#include "instruments/conformance/conformance.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// All findings of the job conform, with their verdict.
struct ConformReport {
  std::string material;  ///< name and parameters
  std::vector<double> wavelengths_nm;
  ExaminationEffort effort;
  double false_alarm_rate = 0;
  double level = 0;  ///< p-value below which a test fails
  Findings findings;

  bool all_hold() const;
};

/// Returns text for a terminal: a line for each law, and the failures of broken laws.
std::string conform_text(const ConformReport& report);
/// Returns the settings of the test, and whether all laws hold.
std::vector<Fact> conform_facts(const ConformReport& report);
/// Returns the tables "laws" (verdicts) and "findings" (all tests).
std::vector<Table> conform_tables(const ConformReport& report);

/// Returns the finding to draw: the one with the smallest p-value among those with a map; only broken laws are
/// considered if there are any. nullptr if no finding has a map.
const Finding* finding_to_draw(const ConformReport& report);

/// Returns a finding's map: both hemispheres of wi in equal-area projection. The colour of a patch is found / expected,
/// or found if there is no expected value. Requires `finding.map`.
Chart sphere_chart(const Finding& finding);

}  // namespace frond
