#pragma once

#include <string>
#include <vector>

#include "instruments/conformance.h"
#include "report/chart.h"

namespace frond {

/// Everything that `frond conform` found out, judged.
struct ConformReport {
  std::string material;  ///< the words of the command line
  std::vector<double> wavelengths_nm;
  ExaminationEffort effort;
  double false_alarm_rate = 0;
  double level = 0;  ///< p-value below which a test fails
  Findings findings;

  bool all_hold() const;
};

/// For people: a line for each law, and the failures of those that are broken.
std::string conform_text(const ConformReport& report);
std::string conform_json(const ConformReport& report);

/// The finding to draw: of the broken ones, or where all hold of all, that with the smallest p which has a map. nullptr
/// where none has.
const Finding* finding_to_draw(const ConformReport& report);

/// A finding's map: both hemispheres of wi in equal-area projection, each patch in the colour of found / expected, or
/// of found where there is nothing to compare with. Needs `finding.map`.
Chart sphere_chart(const Finding& finding);

}  // namespace frond
