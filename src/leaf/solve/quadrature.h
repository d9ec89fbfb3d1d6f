#pragma once

#include <vector>

namespace frond::leaf {

/// Node and weight of a quadrature rule.
struct QuadratureNode {
  double x, weight;
};

/// Distribution of a chain's nodes over the segments of the range of k.
struct NodeRule {
  int nodes;  ///< per segment; with `by_flux`, of the segments that carry most of the light
  /// Fewer nodes, one at least, for segments that carry little of the light, and less grading of such segments: a
  /// third of the time, at three times the error.
  bool by_flux = false;
};

/// Gauss-Legendre rule on [0, 1] with n >= 1 nodes, ascending.
std::vector<QuadratureNode> gauss_legendre(int n);

}  // namespace frond::leaf
