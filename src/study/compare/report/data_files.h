#pragma once

#include "report/table.h"
#include "study/compare/comparison.h"

namespace frond::compare {

/// Numbers of a comparison: the content of compare.csv and compare.json, and the job's result.
struct ComparisonData {
  /// "comparison": a row for each candidate, number of samples, region and channel; "candidates": a row for each;
  /// "meets_rms": a row for each of `Request::rms` and candidate; "reference": a row for each region and channel.
  std::vector<Table> tables;
  std::vector<Fact> facts;
  std::vector<std::string> notes;
};

ComparisonData data_of(const Comparison& comparison);

}  // namespace frond::compare
