#pragma once

#include <vector>

namespace frond::leaf {

/// Node and weight of a quadrature rule.
struct QuadratureNode {
  double x, weight;
};

/// Gauss-Legendre rule on [0, 1] with n >= 1 nodes, ascending.
std::vector<QuadratureNode> gauss_legendre(int n);

}  // namespace frond::leaf
