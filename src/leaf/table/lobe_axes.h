#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/float4.h"
#include "core/spectrum.h"

namespace frond::leaf {

/// Four neighbouring nodes of an axis of cosines, even in their square root from 0 to 1, and their weights in the cubic
/// through them.
struct CosineNodes {
  static constexpr int kCells = 64;

  Float4 weight;
  size_t first;

  CosineNodes() = default;
  /// `cosine` in [0, 1].
  explicit CosineNodes(float cosine) {
    const float x = std::sqrt(cosine) * kCells;
    const int below = std::clamp(static_cast<int>(x) - 1, 0, kCells - 3);
    first = static_cast<size_t>(below);
    const float t = x - static_cast<float>(below) - 1;
    // Lagrange's polynomials through -1, 0, 1, 2.
    weight = Float4{0, 1, 0, 0};
    weight += t * (Float4{-2, -3, 6, -1} + t * (Float4{3, -6, 3, 0} + t * Float4{-1, 3, -3, 1})) * (1.f / 6);
  }

  /// Cosines of all nodes, ascending.
  static std::vector<double> cosines() {
    std::vector<double> result;
    for (int k = 0; k <= kCells; ++k) result.push_back(std::pow(static_cast<double>(k) / kCells, 2));
    return result;
  }
};

/// Axis of the exponents of a surface's lobe: one, or several for a texture, even in log(1 + e).
class ExponentAxis {
 public:
  ExponentAxis() = default;
  /// Covers `exponents` in steps of at most 0.05 in log(1 + e).
  explicit ExponentAxis(const Interval& exponents) : exponents_{exponents.min} {
    constexpr double kStep = 0.05;
    const double width = std::log1p(exponents.max) - std::log1p(exponents.min);
    const int cells = static_cast<int>(std::ceil(width / kStep));
    for (int i = 1; i <= cells; ++i) exponents_.push_back(std::expm1(std::log1p(exponents.min) + width * i / cells));
    first_ = static_cast<float>(std::log1p(exponents.min));
    per_step_ = cells > 0 ? static_cast<float>(cells / width) : 0;
  }

  const std::vector<double>& exponents() const { return exponents_; }

  /// Position of an exponent between two nodes.
  struct Position {
    size_t below = 0, above = 0;
    float t = 0;  ///< fraction of the distance from `below` to `above`
  };
  Position position(float exponent) const {
    const float last = static_cast<float>(exponents_.size() - 1);
    const float x = std::clamp((std::log1p(exponent) - first_) * per_step_, 0.f, last);
    const auto below = static_cast<size_t>(x);
    return {below, std::min(below + 1, exponents_.size() - 1), x - static_cast<float>(below)};
  }

 private:
  std::vector<double> exponents_{0};
  float first_ = 0, per_step_ = 0;
};

}  // namespace frond::leaf
