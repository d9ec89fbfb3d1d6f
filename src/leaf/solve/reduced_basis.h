#pragma once

#include <functional>
#include <vector>

namespace frond::leaf {

/// Columns as mixtures of a few functions: column c is the sum over k of weights[c][k] functions[k].
struct ReducedBasis {
  std::vector<std::vector<double>> functions;
  std::vector<std::vector<double>> weights;
};

/// As few orthogonal functions as it takes to keep `error` of what they miss of each column to `most`, but no more than
/// `most_functions`; those that matter most come first. Found by the greedy algorithm of reduced basis methods, and
/// then turned to the principal axes of its weights. Four columns or fewer are their own functions; none where all are
/// 0.
ReducedBasis reduce_basis(std::vector<std::vector<double>> columns,
                          const std::function<double(const std::vector<double>&)>& error, double most,
                          size_t most_functions);

}  // namespace frond::leaf
