#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/math/float4.h"
#include "leaf/solve/reduced_basis.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// Four neighbouring nodes of a grid around a sine in [0, 1], and their weights in the cubic through them.
struct SineNodes {
  Float4 weight;
  size_t first;

  SineNodes() = default;
  SineNodes(float sine, int cells) {
    const float x = sine * static_cast<float>(cells);
    const int below = std::min(static_cast<int>(x), cells - 1);
    first = static_cast<size_t>(below);
    const float t = x - static_cast<float>(below);
    // Lagrange's polynomials through -1, 0, 1, 2.
    weight = Float4{0, 1, 0, 0};
    weight += t * (Float4{-2, -3, 6, -1} + t * (Float4{3, -6, 3, 0} + t * Float4{-1, 3, -3, 1})) * (1.f / 6);
  }
};

/// The series of a mode table for one lit side and one exit side, in the form that a render looks up. Columns are
/// linear combinations of a few functions of direction, four of which share a SIMD register: the cost of a look-up
/// hardly depends on the number of columns and lanes, and the table fits into the processor's first-level cache.
class SeriesLookup {
 public:
  SeriesLookup() = default;
  /// Two truncations have an error of at most `tolerance` of pi f each: columns by functions, and functions by their
  /// larger modes.
  SeriesLookup(const ModeTable& spectrum, bool from_below, bool crosses, double tolerance);

  /// Returns the sum of the series in the lanes of `columns`; at least 0.
  Float4 at(const SineNodes& incident, const SineNodes& leaving, float cos_phi, const TableSelection& columns) const {
    const Sums sums = functions_at(incident, leaving, cos_phi);
    Float4 lanes{};
    for (int lane = 0; lane < columns.lane_count; ++lane)
      lanes[lane] =
          mixture(sums, columns.lanes[static_cast<size_t>(lane)], static_cast<size_t>(columns.columns_per_lane));
    return larger(lanes, Float4{});
  }
  /// The same if the lanes are the table's columns, one by one: the columns are then the functions.
  Float4 at(const SineNodes& incident, const SineNodes& leaving, float cos_phi) const {
    const Cosines cosines(cos_phi, modes_);
    const Block block{first_term(incident, leaving), needed(incident, leaving)[0]};
    return larger(sum_block(block, cosines, incident.weight, leaving.weight), Float4{});
  }

  /// Memory in bytes.
  size_t bytes() const { return values_.size() * sizeof(Float4) + weights_.size() * sizeof(Float4); }

 private:
  static constexpr size_t kMostModes = 64, kMostBlocks = 8;
  /// Values of the functions, four by four.
  using Sums = std::array<Float4, kMostBlocks>;

  size_t side() const { return cells_ + 3; }
  size_t cell_count() const { return side() * side(); }
  void set_weights(const ReducedBasis& basis);
  void set_needed(const ReducedBasis& basis, double tolerance);
  void set_values(const ReducedBasis& basis);
  std::vector<double> contribution_bounds(const ReducedBasis& basis, size_t block, size_t mode) const;
  double neighbourhood_bound(const std::vector<double>& size, size_t incident, size_t leaving) const;

  /// cos m phi for all m, by Chebyshev's recurrence.
  struct Cosines {
    std::array<float, kMostModes> of;
    Cosines(float cos_phi, size_t modes) {
      of[0] = 1, of[1] = cos_phi;
      for (size_t m = 2; m < modes; ++m) of[m] = 2 * cos_phi * of[m - 1] - of[m - 2];
    }
  };
  struct Block {
    const Float4* terms;  ///< of the first of the sixteen nodes
    size_t modes;
  };

  const Float4* first_term(const SineNodes& incident, const SineNodes& leaving) const {
    return values_.data() + (incident.first * side() + leaving.first) * terms_;
  }
  const uint8_t* needed(const SineNodes& incident, const SineNodes& leaving) const {
    return &needed_[(incident.first * cells_ + leaving.first) * blocks_];
  }

  Sums functions_at(const SineNodes& incident, const SineNodes& leaving, float cos_phi) const {
    const Cosines cosines(cos_phi, modes_);
    Sums sums;
    const Float4* terms = first_term(incident, leaving);
    for (size_t b = 0; b < blocks_; terms += most_modes_[b++])
      sums[b] = sum_block({terms, needed(incident, leaving)[b]}, cosines, incident.weight, leaving.weight);
    return sums;
  }

  Float4 sum_block(const Block& block, const Cosines& cosines, Float4 incident, Float4 leaving) const {
    Float4 sum{};
    for (size_t m = 0; m < block.modes; ++m) sum += cosines.of[m] * sum_patch(block.terms + m, incident, leaving);
    return sum;
  }

  Float4 sum_patch(const Float4* node, Float4 incident, Float4 leaving) const {
    const size_t row = side() * terms_;
    return (incident[0] * sum_row(node, leaving) + incident[1] * sum_row(node + row, leaving)) +
           (incident[2] * sum_row(node + 2 * row, leaving) + incident[3] * sum_row(node + 3 * row, leaving));
  }
  Float4 sum_row(const Float4* node, Float4 leaving) const {
    return (leaving[0] * node[0] + leaving[1] * node[terms_]) +
           (leaving[2] * node[2 * terms_] + leaving[3] * node[3 * terms_]);
  }

  float mixture(const Sums& sums, const TableSelection::Lane& lane, size_t columns) const {
    Float4 products{};
    for (size_t c = 0; c < columns; ++c)
      for (size_t b = 0; b < blocks_; ++b)
        products += lane.weight[c] * (weights_[lane.column[c] * blocks_ + b] * sums[b]);
    return sum(products);
  }

  size_t cells_ = 0, modes_ = 0, blocks_ = 0;
  std::vector<Float4> weights_;                   ///< of the functions: [column][block]
  std::array<size_t, kMostBlocks> most_modes_{};  ///< of a block, in any cell
  size_t terms_ = 0;                              ///< sum of these
  std::vector<Float4> values_;                    ///< [incident node][leaving node][block][mode]
  std::vector<uint8_t> needed_;                   ///< number of modes, by [incident cell][leaving cell][block]
};

}  // namespace frond::leaf
