#pragma once

#include "leaf/table/lobe_axes.h"
#include "leaf/table/lookup.h"

namespace frond::leaf {

/// Factors that make a leaf of three lobes reciprocal, by direction and column of a TableLookup. On one side
///   f_r(i, o) = s(i) p(i, o) s(o) + d(i) (Rd(i) + Rd(o)) / (2 pi) d(o),
/// where p is the surface's lobe before its cut, and to the other side
///   f_r(i, o) = d(i) (T(i) + T(o)) / (2 pi) d(o).
/// s and d are such that, for light from every direction, the first lobe scatters Rs and the other two Rd + T
/// (docs/leaf_models.md).
class ReciprocalLookup {
 public:
  /// `exponents`: range of the surface lobe's exponents.
  ReciprocalLookup(const TableLookup& shares, const Interval& exponents);

  /// The factors for one direction.
  struct Factors {
    SampledSpectrum surface, subsurface;  ///< s and d by lane; lanes not in use: undefined
    SampledSpectrum back;                 ///< share of Rd + T that leaves on the side of incidence
  };
  using Position = ExponentAxis::Position;
  Position position(float exponent) const { return axis_.position(exponent); }

  /// Returns the factors. cos_theta in [-1, 1] as in TableLookup, whose `select` makes the selection.
  Factors operator()(float cos_theta, const Position& exponent, const TableSelection& selection) const {
    const auto [node, t] = TableLookup::position(cos_theta);
    if (selection.lane_count > 0) return sum_columns(node, t, exponent, selection);
    Factors f;
    f.surface.v = interpolate(surface_lanes_, exponent.below, node, t);
    if (exponent.t > 0)
      f.surface.v += exponent.t * (interpolate(surface_lanes_, exponent.above, node, t) - f.surface.v);
    f.subsurface.v = interpolate(subsurface_lanes_, 0, node, t);
    f.back.v = interpolate(back_lanes_, 0, node, t);
    return f;
  }

 private:
  static constexpr size_t kNodes = TableLookup::kNodes;

  template <class T>
  static T interpolate(const std::vector<T>& values, size_t row, size_t node, float t) {
    const T* at = &values[row * kNodes + node];
    return (1 - t) * at[0] + t * at[1];
  }
  Factors sum_columns(size_t node, float t, const Position& exponent, const TableSelection& selection) const;

  ExponentAxis axis_;
  size_t columns_ = 0;
  std::vector<float> surface_;            ///< [exponent][column][node]
  std::vector<float> subsurface_, back_;  ///< [column][node]
  // The same where lanes are columns, one by one: [exponent][node] and [node].
  std::vector<Float4> surface_lanes_, subsurface_lanes_, back_lanes_;
};

}  // namespace frond::leaf
