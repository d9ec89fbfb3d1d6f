#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/film.h"
#include "core/filter.h"
#include "core/float4.h"

namespace frond {

/// Along one axis: what a sample weighs in the pixels that it reaches.
struct SplatAxis {
  int reach = 0;  ///< pixels on either side of its own
  /// For each of these pixels, from -reach to reach: the mean of the weight, and of its square, over samples that are
  /// spread evenly in their own.
  std::vector<double> mean = {}, square = {};
  bool operator==(const SplatAxis&) const = default;
};

/// That samples are shared: each lies in a pixel of its own, and is added, weighed by the filter, to all pixels within
/// the filter's reach. A pixel's value is sum(w L) / sum(w). As in Mitsuba, and in pbrt up to version 3.
struct Splatting {
  std::array<SplatAxis, 2> axes;  ///< x, y
  bool has_negative_weights = false;
  /// Pixels that share the noise of one: the sum of the magnitudes of its correlation with all of them. Where pixels
  /// are summed up as if they were independent, variances are too small by this factor at most.
  double correlated_pixels = 1;
  Crop sampled{};  ///< pixels whose samples are taken; of a whole image more than the film's crop, by the reach

  /// Of a weight's mean and mean square, for the pixel that lies so many pixels from a sample's own.
  double mean(int dx, int dy) const { return of(axes[0].mean, dx, 0) * of(axes[1].mean, dy, 1); }
  double square(int dx, int dy) const { return of(axes[0].square, dx, 0) * of(axes[1].square, dy, 1); }
  int reach_x() const { return axes[0].reach; }
  int reach_y() const { return axes[1].reach; }
  /// Pixels whose samples reach some pixels of the image, as far as they are taken.
  Crop reaching(const Crop& pixels) const;
  bool operator==(const Splatting&) const = default;

 private:
  double of(const std::vector<double>& values, int d, size_t axis) const {
    return values[size_t(d + axes[axis].reach)];
  }
};

/// Most pixels that a sample reaches on either side of its own.
inline constexpr int kMostReach = 8;

/// With so many pixels more on all sides.
Crop widened(const Crop& pixels, int x, int y);
/// What both have.
Crop intersection(const Crop& a, const Crop& b);

/// What a sample weighs in the pixels around it: along x times along y.
class SplatKernel {
 public:
  explicit SplatKernel(const Filter& filter);

  static constexpr int kMostWidth = 2 * kMostReach + 1;
  struct Weights {
    std::array<float, kMostWidth> x, y;  ///< from -reach on

    /// Of pixels that are counted from -reach; a multiple of kWeightUnit.
    float at(size_t column, size_t row) const {
      constexpr float kRounds = 0x1.8p23f * kWeightUnit;
      return x[column] * y[row] + kRounds - kRounds;
    }
  };
  static constexpr float kWeightUnit = 0x1p-20f;

  /// For a sample at `u` in its pixel, [0, 1)^2.
  Weights at(Vec2 u) const {
    Weights w;
    axes_[0].interpolate(u.x, w.x.data());
    axes_[1].interpolate(u.y, w.y.data());
    return w;
  }
  int width() const { return axes_[0].width; }
  int height() const { return axes_[1].width; }
  /// What there is to know of it; `sampled` is empty.
  Splatting splatting() const;

 private:
  /// The filter along an axis, tabulated at kNodes + 1 places of a sample in its pixel, scaled so that no weight
  /// exceeds 1, nor the sum of a sample's weights does in the mean.
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
    /// Sum over all lags of the magnitude of the autocorrelation of a sample's weights.
    double correlated_pixels() const;
    bool has_negative_weights() const;
    /// Variance of a pixel whose samples all have variance 1, times their number.
    double noise() const;
  };
  friend bool splats(const Filter& filter);

  std::array<Axis, 2> axes_;
};

/// A sample's values as whole numbers, so that sums of them times weights are exact: multiples of 2^(exponent - 26).
struct SplatValue {
  static constexpr int kBits = 26;
  static constexpr int kLeastExponent = -14, kStep = 4;

  explicit SplatValue(const Double4& values);

  int exponent;       ///< kLeastExponent + n kStep; all values are less than 2^exponent
  Double4 multiples;  ///< at most 2^26 in magnitude

  /// Of a sum of multiples times weights: a number of units of 2^(shift - 60).
  static int64_t whole(double sum) { return static_cast<int64_t>(sum * (1 / double(SplatKernel::kWeightUnit))); }
  int shift() const { return exponent - kLeastExponent; }
};

/// What samples of one pixel, of the same exponent, give to each pixel that they reach.
class SplatSums {
 public:
  /// Of nothing yet: `restart` comes first. The room for the widest kernel is not cleared, which would take longer than
  /// a few samples do.
  explicit SplatSums(const SplatKernel* kernel) : kernel_(kernel) {}

  void restart(int exponent);
  std::optional<int> exponent() const { return exponent_; }
  /// Of a sample at `u` in its pixel, [0, 1)^2. At most kMost of them.
  void add(Vec2 u, const SplatValue& value);
  static constexpr int kMost = 64;
  static_assert(kMost * double(1 << SplatValue::kBits) / double(SplatKernel::kWeightUnit) <= 0x1p53);

  /// What a pixel, counted from -reach, gets: units of 2^(shift - 60), and of 2^-30.
  int64_t sum(size_t column, size_t row, size_t color) const {
    const Sums& sums = sums_[at(column, row)];
    return SplatValue::whole(color < 2 ? sums.red_green[color] : sums.blue_weight[0]);
  }
  int shift() const { return *exponent_ - SplatValue::kLeastExponent; }
  int64_t weight(size_t column, size_t row) const { return int64_t(sums_[at(column, row)].blue_weight[1] * 0x1p30); }

 private:
  /// Of colours times weights, and of weights: two and two, which a register holds.
  using Double2 = double __attribute__((vector_size(16)));
  struct Sums {
    Double2 red_green, blue_weight;
  };

  size_t at(size_t column, size_t row) const { return row * size_t(kernel_->width()) + column; }

  const SplatKernel* kernel_;
  std::optional<int> exponent_;
  std::array<Sums, size_t(SplatKernel::kMostWidth) * SplatKernel::kMostWidth> sums_;
};

/// Whether samples are to be shared: as the scene says, or else where that makes less noise than to draw each pixel's
/// own from the filter, were all of an image's samples independent and alike.
bool splats(const Filter& filter);

}  // namespace frond
