#pragma once

#include <vector>

#include "core/parallel.h"
#include "leaf/solve/modes.h"
#include "leaf/table/table_axes.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// All that a ModeTable depends on.
struct ModeTableRequest {
  TissueParams params;
  std::vector<double> wavelengths_nm;
  DepthAxis depths = {};  ///< empty: the leaf's own
  double tolerance;       ///< of pi f: see solve_modes
  int nodes = 0;          ///< per segment; 0: as many as mode_nodes says
};

/// LeafModes of one leaf, on a grid even in the sines of both angles for cubic interpolation: `cells` in [0, 1], and
/// one beyond on either side, so that the ends are like the middle.
struct ModeTable {
  int cells = 0;
  std::vector<double> index = {};     ///< of the cuticle, by column
  std::vector<LeafModes> modes = {};  ///< columns: [wavelength], or [wavelength][depth]
  /// Estimate of the largest error of pi f that interpolation between the sines leaves. At most the tolerance, but
  /// where that would take more than kMostCells.
  double error = 0;
  /// The modes are those of f / ((1 - F_i) (1 - F_o)), which is the same both ways round
  /// (leaf/table/reciprocal_modes.h).
  bool is_reciprocal = false;
};

inline constexpr int kMostCells = 32;

std::vector<double> grid_sines(int cells);

/// The same bits for any number of threads.
ModeTable make_mode_table(const ModeTableRequest& request, const ThreadPool& pool);

}  // namespace frond::leaf
