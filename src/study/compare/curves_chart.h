#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// What is drawn against CPU time.
enum class Measure : uint8_t { rms_all, rms_leaf, flip };

/// Whether any candidate made an error that a logarithmic axis can show.
bool has_curves(const Comparison& comparison, Measure measure);

/// A gnuplot script for what has curves: error against CPU time, both logarithmic, one curve for each candidate with 95
/// % intervals, the Pareto frontier behind them; RMS charts show each candidate's bias and from when on noise is below
/// it.
std::string curves_chart(const Comparison& comparison, Measure measure);

}  // namespace frond::compare
