#include "leaf/solve/quadrature.h"

#include <cmath>
#include <numbers>

namespace frond::leaf {
namespace {

/// Legendre polynomial of degree n and its derivative, |x| < 1.
struct Legendre {
  double value, slope;
};

Legendre legendre(int n, double x) {
  double before = 1, value = x;
  for (int i = 2; i <= n; ++i) {
    const double next = ((2 * i - 1) * x * value - (i - 1) * before) / i;
    before = value;
    value = next;
  }
  return {value, n * (x * value - before) / (x * x - 1)};
}

}  // namespace

std::vector<QuadratureNode> gauss_legendre(int n) {
  std::vector<QuadratureNode> nodes;
  for (int i = n; i >= 1; --i) {
    double x = std::cos(std::numbers::pi * (i - 0.25) / (n + 0.5));
    for (int step = 0; step < 8; ++step) {
      const auto [value, slope] = legendre(n, x);
      x -= value / slope;
    }
    const double slope = legendre(n, x).slope;
    nodes.push_back({(x + 1) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

}  // namespace frond::leaf
