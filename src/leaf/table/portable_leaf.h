#pragma once

#include <array>
#include <string>
#include <vector>

#include "leaf/table/lobe_axes.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// The solved leaf as plain arrays, for other programs (docs/leaf_file.md; exports/cpp/frond_leaf.h evaluates it):
/// all that `leaf_solved` looks up, its surface too.
struct PortableLeaf {
  /// Cosines of a direction to the normal at which `surface` stands: (k / kCosineCells)^2, k from 0 on.
  static constexpr size_t kCosineCells = CosineNodes::kCells;

  bool is_reciprocal = false;          ///< else f is that of incident "traced"
  size_t cells = 0;                    ///< of sines in [0, 1]: nodes go from -1 / cells to 1 + 1 / cells
  double exponent = 0;                 ///< of the surface's lobe
  std::vector<double> wavelengths_nm;  ///< ascending
  std::vector<double> depths;          ///< optical, of the mesophyll, ascending; empty: that of each wavelength
  std::vector<float> index;            ///< of the cuticle, by wavelength
  /// By column, and cosine: what the surface's lobe is divided by. Of a reciprocal leaf the I of F(i) / I(i) p F(o) /
  /// I(o), by wavelength; else what the plane leaves of the lobe, of one row.
  std::vector<float> surface;
  /// [lit from below][crosses]: [column][mode][incident sine][leaving sine]; columns are wavelengths, or
  /// [wavelength][depth].
  std::array<std::array<std::vector<float>, 2>, 2> series;
  std::array<std::array<size_t, 2>, 2> modes{};  ///< of each of these
  /// Shares of light that has come in, for sampling: [lit from below]: [column][incident sine][back, across].
  std::array<std::vector<float>, 2> ways;

  size_t side() const { return cells + 3; }
  size_t columns() const { return wavelengths_nm.size() * std::max<size_t>(1, depths.size()); }
};

/// `spectrum` is of `request`, whose wavelengths ascend; `exponent` of the surface's lobe.
PortableLeaf make_portable(const ModeTableRequest& request, const ModeTable& spectrum, double exponent);

/// As a file holds it: docs/leaf_file.md.
std::string portable_bytes(const PortableLeaf& leaf);

}  // namespace frond::leaf
