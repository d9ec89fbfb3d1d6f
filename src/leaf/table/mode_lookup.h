#pragma once

#include <array>
#include <vector>

#include "leaf/table/series_lookup.h"

namespace frond::leaf {

/// A ModeTable as a render looks it up: by the cubics through the four neighbours in both sines, linearly between
/// wavelengths.
class ModeLookup {
 public:
  /// The lanes of paths are the request's wavelengths, one by one; else (`lanes_vary`) they lie anywhere among them,
  /// and these ascend and are two at least.
  ModeLookup(const ModeTableRequest& request, const ModeTable& spectrum, bool lanes_vary);

  /// What the lanes of a path look at.
  struct Selection {
    TableSelection columns;
    SampledSpectrum index;  ///< of the cuticle; some index in lanes not in use, too
  };
  Selection select(const SampledWavelengths& lambda) const;
  /// With the leaf's optical depth in each lane, of a request with depths.
  Selection select(const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) const;
  /// Whether `select` gives the same for all paths.
  bool lanes_are_columns() const { return wavelengths_.empty() && depths_.empty(); }

  using Nodes = SineNodes;
  /// Around a sine in [0, 1].
  Nodes nodes(float sine) const { return {sine, static_cast<int>(cells_)}; }

  /// The sum over modes of LeafModes, lane by lane. Where interpolation and missing modes leave less than nothing: 0.
  Float4 series(bool from_below, bool crosses, const Nodes& incident, const Nodes& leaving, float cos_phi,
                const TableSelection& columns) const {
    const SeriesLookup& table = series_[from_below][crosses];
    return lanes_are_columns() ? table.at(incident, leaving, cos_phi) : table.at(incident, leaving, cos_phi, columns);
  }

  /// A direction outside.
  struct Way {
    bool below;
    float sine;
    Nodes nodes;
  };
  /// The same of a reciprocal spectrum: to the last bit the same both ways round.
  Float4 mutual(const Way& a, const Way& b, float cos_phi, const TableSelection& columns) const {
    const bool crosses = a.below != b.below, in_order = crosses ? b.below : a.sine >= b.sine;
    const Way &first = in_order ? a : b, &second = in_order ? b : a;
    return series(first.below, crosses, first.nodes, second.nodes, cos_phi, columns);
  }

  /// Shares of light that came in through the surface.
  struct Ways {
    float back, across;
    float across_to;  ///< where it met the other side: crosses to this one
  };
  /// Sums over the lanes of `light`, which has come in, times these shares.
  Ways ways(bool from_below, const Nodes& incident, Float4 light, const TableSelection& columns) const;

  /// Least and greatest index of the cuticle.
  Interval indices() const;
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
