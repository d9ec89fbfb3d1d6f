#pragma once

#include "leaf/table/lobe_axes.h"

namespace frond::leaf {

/// Factors that make a surface's lobe reciprocal (LobeScaler) where it reflects by Fresnel's formula: a table over
/// cosine, index of refraction and exponent. Cubic in the index, which varies little over a leaf's spectrum.
class SurfaceScaling {
 public:
  SurfaceScaling() = default;
  /// Tabulates over these ranges.
  SurfaceScaling(const Interval& exponents, const Interval& indices);

  using Position = ExponentAxis::Position;
  Position position(float exponent) const { return axis_.position(exponent); }

  /// Returns I of LobeScaler for a direction of this cosine to the normal, in each lane.
  Float4 at(const Position& exponent, float cosine, Float4 index) const {
    const CosineNodes nodes(std::min(cosine, 1.f));
    Float4 c = row(exponent.below, nodes);
    if (exponent.t > 0) c += exponent.t * (row(exponent.above, nodes) - c);
    const Float4 x = (index - middle_) * per_width_;
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
  }

 private:
  Float4 row(size_t exponent, const CosineNodes& nodes) const {
    const Float4* p = &cubics_[exponent * (CosineNodes::kCells + 1) + nodes.first];
    return (nodes.weight[0] * p[0] + nodes.weight[1] * p[1]) + (nodes.weight[2] * p[2] + nodes.weight[3] * p[3]);
  }

  ExponentAxis axis_;
  float middle_ = 0, per_width_ = 0;  ///< middle of the indices; 1 / (half their range)
  std::vector<Float4> cubics_;        ///< [exponent][cosine]: coefficients
};

}  // namespace frond::leaf
