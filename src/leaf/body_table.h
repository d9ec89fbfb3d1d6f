#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/spectrum.h"
#include "leaf/body_spectrum.h"

namespace frond::leaf {

/// A BodySpectrum as a render looks it up: by the cubics through the four neighbours in both sines, linearly between
/// wavelengths.
class BodyTable {
 public:
  /// The lanes of paths are the request's wavelengths, one by one; else (`lanes_vary`) they lie anywhere among them,
  /// and these ascend and are two at least.
  BodyTable(const BodyRequest& request, const BodySpectrum& spectrum, bool lanes_vary);

  /// What the lanes of a path look at.
  struct Selection {
    TableSelection columns;
    SampledSpectrum index;  ///< of the cuticle; some index in lanes not in use, too
  };
  Selection select(const SampledWavelengths& lambda) const;
  /// With the leaf's optical depth in each lane, of a request with depths.
  Selection select(const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) const;

  /// The four nodes around a sine in [0, 1].
  struct Nodes {
    size_t first;
    std::array<float, 4> weight;
  };
  Nodes nodes(float sine) const;

  /// The sum over modes of BodyModes, lane by lane. Where interpolation and missing modes leave less than nothing: 0.
  SampledSpectrum series(bool from_below, bool crosses, const Nodes& incident, const Nodes& leaving, float cos_phi,
                         const TableSelection& columns) const;
  /// Of the light that came in through the surface, what comes back or crosses.
  SampledSpectrum share(bool from_below, bool crosses, const Nodes& incident, const TableSelection& columns) const;

  size_t bytes() const;

 private:
  /// Four modes of one node in one column, in one register.
  using FourModes = float __attribute__((vector_size(16)));
  static constexpr size_t kMostBlocks = 16;
  using Modes = std::array<FourModes, kMostBlocks>;
  /// For one side lit and one way out.
  struct Part {
    size_t blocks;                  ///< of four modes
    std::vector<FourModes> values;  ///< [incident node][leaving node][column][block]
    std::vector<float> shares;      ///< [incident node][column]
  };
  /// Sixteen nodes around a pair of sines.
  struct Patch {
    size_t first;                                ///< node
    std::array<std::array<float, 4>, 4> weight;  ///< [incident][leaving]
  };

  size_t side() const { return static_cast<size_t>(cells_) + 3; }
  Part make_part(const BodySpectrum& spectrum, bool from_below, bool crosses) const;
  void add_shares(Part& part) const;
  Selection with_index(const TableSelection& columns) const;
  double index_of(size_t column) const { return index_[column]; }
  Patch patch(const Nodes& incident, const Nodes& leaving) const;
  FourModes sum_patch(const Part& part, const Patch& patch, size_t column, size_t block) const;
  float sum_modes(const Part& part, const Patch& patch, const TableSelection::Lane& lane, size_t columns,
                  const Modes& cosines) const;

  int cells_;
  size_t columns_;
  std::vector<double> index_;   ///< [column]
  WavelengthAxis wavelengths_;  ///< empty: lanes are wavelengths
  DepthAxis depths_;            ///< empty: the depth does not vary
  std::array<std::array<Part, 2>, 2> parts_;
};

}  // namespace frond::leaf
