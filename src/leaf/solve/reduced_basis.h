#pragma once

#include <functional>
#include <vector>

namespace frond::leaf {

/// Low-rank approximation of columns: column c is the sum over k of weights[c][k] functions[k].
struct ReducedBasis {
  std::vector<std::vector<double>> functions;
  std::vector<std::vector<double>> weights;
};

/// Returns the fewest orthogonal functions for which `error` of each column's residual is at most `most`, but no more
/// than `most_functions`; most important first. Found by the greedy algorithm of reduced basis methods, then rotated to
/// the principal axes of its weights. Four columns or fewer are returned as their own functions; no functions if all
/// columns are 0.
ReducedBasis reduce_basis(std::vector<std::vector<double>> columns,
                          const std::function<double(const std::vector<double>&)>& error, double most,
                          size_t most_functions);

}  // namespace frond::leaf
