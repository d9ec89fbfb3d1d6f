#pragma once

#include <string>
#include <vector>

#include "instruments/conformance/conformance.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// All findings of the job conform, judged.
struct ConformReport {
  std::string material;  ///< its text
  std::vector<double> wavelengths_nm;
  ExaminationEffort effort;
  double false_alarm_rate = 0;
  double level = 0;  ///< p-value below which a test fails
  Findings findings;

  bool all_hold() const;
};

/// For a terminal: a line for each law, and the failures of those that are broken.
std::string conform_text(const ConformReport& report);
/// How it was tested, and whether all laws hold.
std::vector<Fact> conform_facts(const ConformReport& report);
/// "laws": verdicts; "findings": each test.
std::vector<Table> conform_tables(const ConformReport& report);

/// The finding to draw: of the broken ones, or where all hold of all, that with the smallest p which has a map. nullptr
/// where none has.
const Finding* finding_to_draw(const ConformReport& report);

/// A finding's map: both hemispheres of wi in equal-area projection, each patch in the colour of found / expected, or
/// of found where there is nothing to compare with. Needs `finding.map`.
Chart sphere_chart(const Finding& finding);

}  // namespace frond
