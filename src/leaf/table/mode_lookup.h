#pragma once

#include <array>
#include <vector>

#include "leaf/table/series_lookup.h"

namespace frond::leaf {

/// A mode table in the form that a render looks up: cubic interpolation between four neighbours in both sines, linear
/// between wavelengths.
class ModeLookup {
 public:
  /// `lanes_vary` false: lanes of paths are the request's wavelengths, one by one. True: lanes lie anywhere among
  /// these, which ascend and are at least two.
  ModeLookup(const ModeTableRequest& request, const ModeTable& spectrum, bool lanes_vary);

  /// The columns that the lanes of a path use.
  struct Selection {
    TableSelection columns;
    SampledSpectrum index;  ///< of the cuticle; a valid index also in lanes not in use
  };
  /// The columns of a path's lanes, of a table without depths.
  Selection select(const SampledWavelengths& lambda) const;
  /// The same for a request with depths, at the leaf's optical depth in each lane.
  Selection select(const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) const;
  /// Whether `select` returns the same for all paths.
  bool lanes_are_columns() const { return wavelengths_.empty() && depths_.empty(); }

  using Nodes = SineNodes;
  /// The four nodes around a sine in [0, 1].
  Nodes nodes(float sine) const { return {sine, static_cast<int>(cells_)}; }

  /// Returns the sum over modes of LeafModes in each lane; values below 0, left by interpolation and truncation, become
  /// 0.
  Float4 series(bool from_below, bool crosses, const Nodes& incident, const Nodes& leaving, float cos_phi,
                const TableSelection& columns) const {
    const SeriesLookup& table = series_[from_below][crosses];
    return lanes_are_columns() ? table.at(incident, leaving, cos_phi) : table.at(incident, leaving, cos_phi, columns);
  }

  /// A direction outside the leaf.
  struct Way {
    bool below;
    float sine;
    Nodes nodes;
  };
  /// The same for a reciprocal table: bitwise equal if the directions are exchanged.
  Float4 reciprocal_value(const Way& a, const Way& b, float cos_phi, const TableSelection& columns) const {
    const bool crosses = a.below != b.below, in_order = crosses ? b.below : a.sine >= b.sine;
    const Way &first = in_order ? a : b, &second = in_order ? b : a;
    return series(first.below, crosses, first.nodes, second.nodes, cos_phi, columns);
  }

  /// Shares of the light that came in through the surface and leaves on the same side and on the other.
  struct Ways {
    float back, across;
    float across_to;  ///< share that leaves on this side of light that met the other side
  };
  /// Returns the sums over the lanes of `light`, which has come in, times these shares.
  Ways ways(bool from_below, const Nodes& incident, Float4 light, const TableSelection& columns) const;

  /// Smallest and largest refractive index of the cuticle.
  Interval indices() const;
  /// Memory of the series, in bytes.
  size_t bytes() const;

 private:
  void add_ways(const ModeTable& spectrum);
  Selection with_index(const TableSelection& columns) const;

  size_t cells_;
  std::vector<float> index_;    ///< of the cuticle, by column
  WavelengthAxis wavelengths_;  ///< empty: lanes are wavelengths
  DepthAxis depths_;            ///< empty: the depth does not vary
  std::array<std::array<SeriesLookup, 2>, 2> series_;
  std::array<std::vector<Float4>, 2> ways_;  ///< [column][incident node]: as Ways has them
};

}  // namespace frond::leaf
