#pragma once

#include <cstdint>

#include "instruments/errors/statistics.h"

namespace frond {

// Power of the tests in statistics.h: the smallest error that a test at a significance level finds with a probability
// `power`.

/// Smallest difference between an expectation and the bound of a one-sided test that is found, if the estimate has the
/// variance and skewness of `a`.
double detectable_difference(const Estimate& a, double level, double power);

/// Smallest distance of a success probability below `low`, the lower end of binomial_p's interval, that is found;
/// infinite if none is.
double detectable_shortfall(int64_t trials, double low, double level, double power);
/// Smallest distance between the upper end of this interval and a success probability above it that is found, by the
/// probability.
double detectable_surplus(int64_t trials, double probability, double level, double power);

/// Smallest deviation that the chi-square test finds among `count` counted events: the RMS of the classes' relative
/// deviations, weighted by their probabilities (the effect size w of Cohen 1988).
double detectable_deviation(int freedom, double count, double level, double power);

/// Smallest share of cases that violate a rule such that one of them is among `trials` cases.
double detectable_share(double trials, double power);

}  // namespace frond
