#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/film.h"
#include "core/filter.h"
#include "core/math/float4.h"

namespace frond {

/// Statistics of the weights of splatted samples along one axis.
struct SplatAxis {
  int reach = 0;  ///< number of pixels that a sample reaches on either side of its own
  /// For each offset from -reach to reach: the mean of the weight and of its square over samples that are uniform in
  /// their pixel.
  std::vector<double> mean = {}, square = {};
  bool operator==(const SplatAxis&) const = default;
};

/// Parameters of splatting: each sample is added, weighted by the filter, to all pixels within the filter's radius. The
/// value of a pixel is sum(w L) / sum(w), as in Mitsuba and in pbrt up to version 3.
struct Splatting {
  std::array<SplatAxis, 2> axes;  ///< x, y
  bool has_negative_weights = false;
  /// Sum of the magnitudes of the correlations of a pixel's noise with all pixels, itself included. The variance of a
  /// sum of pixels is at most this factor times that of independent pixels.
  double correlated_pixels = 1;
  Crop sampled{};  ///< pixels whose samples are taken; for a whole image the film's crop, widened by the reach

  /// Mean of the weight, and of its square, of a sample in the pixel at this offset from the sample's own.
  double mean(int dx, int dy) const { return value_at(axes[0].mean, dx, 0) * value_at(axes[1].mean, dy, 1); }
  double square(int dx, int dy) const { return value_at(axes[0].square, dx, 0) * value_at(axes[1].square, dy, 1); }
  int reach_x() const { return axes[0].reach; }
  int reach_y() const { return axes[1].reach; }
  /// Pixels in `sampled` whose samples reach some of these pixels.
  Crop reaching(const Crop& pixels) const;
  bool operator==(const Splatting&) const = default;

 private:
  double value_at(const std::vector<double>& values, int d, size_t axis) const {
    return values[size_t(d + axes[axis].reach)];
  }
};

/// Upper limit of SplatAxis::reach.
inline constexpr int kMostReach = 8;

/// The rectangle enlarged by x pixels to the left and right and by y pixels at the top and bottom.
Crop widened(const Crop& pixels, int x, int y);
/// Pixels in both rectangles; width or height are 0 or negative if there are none.
Crop intersection(const Crop& a, const Crop& b);

/// Tabulated filter: the weights of a sample in the pixels around it, as products of a weight along x and one along y.
class SplatKernel {
 public:
  explicit SplatKernel(const Filter& filter);

  static constexpr int kMostWidth = 2 * kMostReach + 1;
  struct Weights {
    std::array<float, kMostWidth> x, y;  ///< element 0 is at the offset -reach

    /// Weight of a pixel, a multiple of kWeightUnit. Column and row are 0 at the offset -reach.
    float at(size_t column, size_t row) const {
      constexpr float kRounds = 0x1.8p23f * kWeightUnit;
      return x[column] * y[row] + kRounds - kRounds;
    }
  };
  static constexpr float kWeightUnit = 0x1p-20f;

  /// Weights of a sample at the position `u` in its pixel, [0, 1)^2.
  Weights at(Vec2 u) const {
    Weights w;
    axes_[0].interpolate(u.x, w.x.data());
    axes_[1].interpolate(u.y, w.y.data());
    return w;
  }
  /// Number of pixels that a sample reaches in x and in y: 2 reach + 1.
  int width() const { return axes_[0].width; }
  int height() const { return axes_[1].width; }
  /// Statistics of the weights; `sampled` is empty.
  Splatting splatting() const;

 private:
  /// The filter along an axis, tabulated at kNodes + 1 positions of a sample in its pixel. It is scaled so that no
  /// weight, nor the mean of the sum of a sample's weights, exceeds 1.
  struct Axis {
    static constexpr int kNodes = 256;
    int reach, width;
    std::vector<float> table;  ///< [node][pixel]

    template <class F>
    Axis(float radius, const F& value);
    void interpolate(float u, float* weights) const {
      const float place = u * kNodes;
      const int node = std::min(int(place), kNodes - 1);
      const float t = place - float(node);
      const float* const low = &table[size_t(node * width)];
      for (int i = 0; i < width; ++i) weights[i] = low[i] + (low[i + width] - low[i]) * t;
    }
    double weight(double u, int pixel) const;
    SplatAxis described() const;
    /// Sum over all lags of the magnitude of the autocorrelation of the weights.
    double correlated_pixels() const;
    bool has_negative_weights() const;
    /// Variance of a pixel times its number of samples, for samples of variance 1.
    double noise() const;
  };
  friend bool splats(const Filter& filter);

  std::array<Axis, 2> axes_;
};

/// Values of a sample, rounded to multiples of 2^(exponent - 26), so that sums of their products with weights are
/// exact.
struct SplatValue {
  static constexpr int kBits = 26;
  static constexpr int kLeastExponent = -14, kStep = 4;

  SplatValue() = default;  // leaves the members uninitialized, for arrays
  explicit SplatValue(const Double4& values);

  int exponent;       ///< kLeastExponent + n kStep; all values are below 2^exponent
  Double4 multiples;  ///< integers of at most 2^26 in magnitude
  bool is_black;      ///< all values are rounded to 0, and so they are with any other exponent

  /// Converts a sum of multiples times weights to units of 2^(shift - 60).
  static int64_t whole(double sum) { return static_cast<int64_t>(sum * (1 / double(SplatKernel::kWeightUnit))); }
  int shift() const { return exponent - kLeastExponent; }
};

/// Sums of the weighted values that samples of one pixel, of the same exponent, contribute to each pixel around it.
class SplatSums {
 public:
  /// Call `restart` before `add`. The constructor does not clear the array for the widest kernel: that would take
  /// longer than adding a few samples.
  explicit SplatSums(const SplatKernel* kernel) : kernel_(kernel) {}

  /// Resets the sums to 0 and sets the exponent of the samples that follow.
  void restart(int exponent);
  /// Adds a sample at the position `u` in its pixel, [0, 1)^2; at most kMost samples between two calls of `restart`.
  void add(Vec2 u, const SplatValue& value);
  static constexpr int kMost = 64;
  static_assert(kMost * double(1 << SplatValue::kBits) / double(SplatKernel::kWeightUnit) <= 0x1p53);

  /// Sum of a colour, in units of 2^(shift - 60), and sum of weights, in units of 2^-30, of the pixel in this column
  /// and row, which are 0 at the offset -reach.
  int64_t sum(size_t column, size_t row, size_t color) const {
    return SplatValue::whole(sums_[at(column, row)][color]);
  }
  int shift() const { return exponent_ - SplatValue::kLeastExponent; }
  int64_t weight(size_t column, size_t row) const { return int64_t(sums_[at(column, row)][3] * 0x1p30); }

 private:
  size_t at(size_t column, size_t row) const { return row * size_t(kernel_->width()) + column; }

  const SplatKernel* kernel_;
  int exponent_ = 0;
  /// Sums of three colours times weights, and of weights.
  std::array<Double4, size_t(SplatKernel::kMostWidth) * SplatKernel::kMostWidth> sums_;
};

/// True if the scene states splatting for the filter, or states nothing and splatting has less noise than importance
/// sampling of the filter for independent samples of equal variance.
bool splats(const Filter& filter);

}  // namespace frond
