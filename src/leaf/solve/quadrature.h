#pragma once

#include <vector>

namespace frond::leaf {

struct QuadratureNode {
  double x, weight;
};

/// Gauss-Legendre on [0, 1], n >= 1 nodes, ascending.
std::vector<QuadratureNode> gauss_legendre(int n);

}  // namespace frond::leaf
