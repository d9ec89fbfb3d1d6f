#pragma once

#include <string>
#include <vector>

#include "instruments/conformance/conformance.h"
#include "report/chart.h"
#include "report/table.h"

namespace frond {

/// The sets of parameters that the job conform has tested.
struct TestedParameters {
  bool are_defaults = true;  ///< the first set: no parameter is given
  bool given_only = false;   ///< on request, this set alone
  bool are_swept = false;    ///< corners and points inside, too
  size_t sets = 1;
  int samples_at_ends = 0;                    ///< of all sets but the first
  std::vector<std::string> varied, unvaried;  ///< names, with what is left out of their ranges
  std::vector<std::string> refused = {};      ///< sets that the plug-in refuses, with its reasons
};

/// All findings of the job conform, with their verdict.
struct ConformReport {
  std::string material;  ///< name and parameters
  std::vector<double> wavelengths_nm;
  ExaminationEffort effort;
  TestedParameters parameters = {};
  double level = 0;  ///< p-value below which a test fails
  Findings findings = {};

  bool all_hold() const;
};

/// Returns text for a terminal: for each law the verdict, the largest measured value and the smallest error that would
/// have been found; the failures of broken laws; what was not tested.
std::string conform_text(const ConformReport& report);
/// Returns the last sentence: broken laws, or the parameters at which none was found broken.
std::string conform_verdict(const ConformReport& report);
/// Returns the settings of the test, its verdict, and whether all laws hold.
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
