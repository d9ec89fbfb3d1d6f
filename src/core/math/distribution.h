#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/vec.h"

namespace frond {

/// Piecewise constant density over n cells, sampled by inversion with a guide table (Chen and Asau 1974).
class Distribution1D {
 public:
  struct Sample {
    size_t cell;
    float fraction;  ///< position within the cell, [0, 1); uniform, so it can be reused as a random number
    float pdf;       ///< probability of the cell
  };
  /// Weights must be finite and >= 0; if all are zero, the density is uniform.
  explicit Distribution1D(const std::vector<float>& weights);

  Sample sample(float u) const;
  float probability(size_t cell) const { return static_cast<float>(cdf_[cell + 1] - cdf_[cell]); }
  size_t size() const { return cdf_.size() - 1; }
  double sum() const { return sum_; }  ///< of the weights

 private:
  std::vector<double> cdf_;
  std::vector<uint32_t> guide_;  ///< first cell to search for each nth of the unit interval
  double sum_ = 0;
};

/// Piecewise constant density over the unit square.
class Distribution2D {
 public:
  struct Sample {
    Vec2 uv;
    float pdf;  ///< per unit area of the square
  };
  /// Row-major weights, `width` in each row.
  Distribution2D(const std::vector<float>& weights, int width);

  Sample sample(Vec2 u) const;
  float pdf(Vec2 uv) const;

 private:
  std::vector<Distribution1D> rows_;
  Distribution1D marginal_;
};

/// Piecewise constant density over a window of the unit square, by a summed-area table (Bitterli et al. 2015,
/// "Portal-Masked Environment Map Sampling").
class WindowedDistribution {
 public:
  struct Window {
    Vec2 min, max;
    bool contains(Vec2 p) const { return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y; }
  };
  struct Sample {
    Vec2 uv;
    float pdf;  ///< per unit area of the square
  };
  /// Row-major weights, `width` in each row; finite and >= 0.
  WindowedDistribution(const std::vector<float>& weights, int width);

  /// Returns nullopt if all weights in the window are 0.
  std::optional<Sample> sample(Vec2 u, const Window& window) const;
  /// Returns 0 outside the window.
  float pdf(Vec2 uv, const Window& window) const;

 private:
  struct Box {
    double x0, x1, y0, y1;  ///< in cells
  };
  Box box(const Window& window) const;
  /// Returns the interpolated summed-area table.
  double cumulative(double x, double y) const;
  double sum(const Box& b) const;
  double weight(int x, int y) const { return sum({double(x), double(x + 1), double(y), double(y + 1)}); }

  int width_, height_;
  std::vector<double> sums_;  ///< summed-area table: sum of the cells below and left of each corner
};

}  // namespace frond
