#pragma once

#include <memory>

#include "core/parallel.h"
#include "leaf/fit/fit_problem.h"

/// The search for the leaf that fits best. Included by .cpp files of this folder alone, which keeps Eigen out of other
/// modules.
namespace frond::leaf {

/// End of a search.
struct FoundLeaf {
  std::unique_ptr<LeafSpace> space;
  Eigen::VectorXd logs;                     ///< of the free parameters
  std::vector<OpticsSurface::Pair> solved;  ///< R and T of each row, from the solver of the walk
  SurfaceExpansion expansion;               ///< about the leaf
};

/// Returns the leaf of least squares. `rows`: of the request; `cache`: as in fit_leaf.
FoundLeaf search_leaf(const FitRequest& request, const FitRows& rows, const ThreadPool& pool, FitCache& cache);

/// Rows up to which each one is solved on its own.
inline constexpr size_t kMostSolvedRows = 450;

/// Returns R and T of a leaf at each row, by the solver of the walk. If there are more than kMostSolvedRows rows, as in
/// spectra in steps of 1 nm, only as many are solved; at the others their difference from an accurate OpticsSurface is
/// interpolated.
std::vector<OpticsSurface::Pair> solve_rows(const FitRows& rows, const TissueParams& params, const ThreadPool& pool);

}  // namespace frond::leaf
