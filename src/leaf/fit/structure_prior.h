#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "leaf/tissue/leaf_numbers.h"

namespace frond::leaf {

struct FitRequest;
struct FitResult;

/// Distribution of what R alone or T alone does not determine: the structure, and the absorption that is the same at
/// all wavelengths. Independent normal distributions of coordinates; of bifacial leaves with the sieve effect and
/// PROSPECT-D's absorption.
struct StructurePrior {
  std::string source;  ///< leaves from which it was learned
  /// Of the coordinates of prior_numbers(): logarithms, that of an absorption of its optical depth; shares as they are.
  std::vector<double> mean, deviation;
  double error = 0;     ///< RMS of the residuals of their fits
  double reach_nm = 0;  ///< the correlation of two residuals is exp(-distance / reach)

  /// Standard deviation of the logarithm of a parameter with this value; nullopt: the prior is not about it.
  std::optional<double> relative_deviation(const LeafNumber& number, double value) const;
  /// Variance of a residual, times the number of neighbours that vary with it if measurements are `step_nm` apart: what
  /// the squares of residuals are to be divided by, although these are not independent.
  double variance(double step_nm) const;
};

/// The fitted numbers of which there is a prior: those without a spectrum of their own.
const std::vector<const LeafNumber*>& prior_numbers();

/// Returns the coordinates of a leaf, in the order of prior_numbers().
std::vector<double> prior_coordinates(const TissueParams& params);

/// Fits leaves of which R and T were measured, as the prior's kind of leaf, and returns the distribution of their
/// coordinates. Requires three leaves at least.
StructurePrior learn_prior(std::span<const FitRequest> leaves, std::string source);

/// The prior of the seven leaves of tests/reference.
const StructurePrior& built_in_prior();

/// Returns the prior that a fit of the request uses: its `structure_prior` where only R or only T was measured, there
/// is no other prior, and the request allows the prior's kind of leaf; otherwise nullptr.
const StructurePrior* used_prior(const FitRequest& request);

}  // namespace frond::leaf
