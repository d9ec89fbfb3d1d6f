#pragma once

#include <vector>

#include "core/parallel.h"
#include "leaf/solve/modes.h"
#include "leaf/table/table_axes.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Input of `make_mode_table`.
struct ModeTableRequest {
  TissueParams params;
  std::vector<double> wavelengths_nm;
  DepthAxis depths = {};  ///< empty: the leaf's own optical depth
  double tolerance;       ///< largest error of pi f: see solve_modes
  int nodes = 0;          ///< per segment; 0: as many as mode_nodes returns
};

/// LeafModes of one leaf over wavelengths, on a grid even in the sines of both angles for cubic interpolation: `cells`
/// in [0, 1] and one beyond on either side, so that the first and last cell have four neighbours too.
struct ModeTable {
  int cells = 0;
  std::vector<double> index = {};     ///< of refraction, of the cuticle, by column
  std::vector<LeafModes> modes = {};  ///< columns: [wavelength], or [wavelength][depth]
  /// Estimated largest error of pi f by interpolation between the sines. At most the tolerance, unless that requires
  /// more than kMostCells cells.
  double error = 0;
  /// The modes are of f / ((1 - F_i) (1 - F_o)), which is symmetric in its directions (leaf/table/reciprocal_modes.h).
  bool is_reciprocal = false;
};

/// Largest number of cells that `make_mode_table` tries.
inline constexpr int kMostCells = 32;

/// Sines of a grid's nodes, from -1 / cells to 1 + 1 / cells.
std::vector<double> grid_sines(int cells);

/// Solves the mode table. Bitwise equal for any number of threads.
ModeTable make_mode_table(const ModeTableRequest& request, const ThreadPool& pool);

}  // namespace frond::leaf
