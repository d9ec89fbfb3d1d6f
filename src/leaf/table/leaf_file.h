#pragma once

#include <array>
#include <string>
#include <vector>

#include "leaf/table/lobe_axes.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// The solved leaf as plain arrays for other programs (docs/file_formats.md; exports/cpp/frond_leaf.h evaluates it):
/// everything that `leaf_solved` looks up, including its surface.
struct LeafFile {
  /// Number of cells of the cosines at which `surface` is given: (k / kCosineCells)^2, k = 0 ... kCosineCells.
  static constexpr size_t kCosineCells = CosineNodes::kCells;

  bool is_reciprocal = false;          ///< else f of incident "traced"
  size_t cells = 0;                    ///< of sines in [0, 1]: nodes go from -1 / cells to 1 + 1 / cells
  double exponent = 0;                 ///< of the surface's lobe
  std::vector<double> wavelengths_nm;  ///< ascending
  std::vector<double> depths;          ///< optical, of the mesophyll, ascending; empty: one for each wavelength
  std::vector<float> index;            ///< of the cuticle, by wavelength
  /// Divisor of the surface's lobe, [row][cosine]. Reciprocal leaf: the I of F(i) / I(i) p F(o) / I(o), a row for each
  /// wavelength; else the share of the lobe that its cut at the plane leaves, in one row.
  std::vector<float> surface;
  /// [lit from below][crosses]: [column][mode][incident sine][leaving sine]; columns are wavelengths, or
  /// [wavelength][depth].
  std::array<std::array<std::vector<float>, 2>, 2> series;
  std::array<std::array<size_t, 2>, 2> modes{};  ///< number of modes of each of these
  /// Shares of the light that has come in, for sampling, [lit from below]: [column][incident sine][back, across].
  std::array<std::vector<float>, 2> ways;

  /// Nodes of the grid of sines in each direction.
  size_t side() const { return cells + 3; }
  /// Number of columns.
  size_t columns() const { return wavelengths_nm.size() * std::max<size_t>(1, depths.size()); }
};

/// Makes the arrays. `spectrum` is the table of `request`, whose wavelengths ascend; `exponent`: of the surface's lobe.
LeafFile make_leaf_file(const ModeTableRequest& request, const ModeTable& spectrum, double exponent);

/// Returns the bytes of the file (docs/file_formats.md).
std::string leaf_file_bytes(const LeafFile& leaf);

}  // namespace frond::leaf
