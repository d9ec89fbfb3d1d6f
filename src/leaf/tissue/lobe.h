#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/math/random.h"
#include "leaf/tissue/lobe_quantiles.h"

namespace frond::leaf {

/// Scattering by a rough cell wall around an ideal direction: density proportional to cos^e of the angle to it
/// (Lafortune and Willems 1994; eq. 2 of Baranoski and Rokne 1998). Directions beyond the plane of the wall are
/// rejected and drawn again.
class Lobe {
 public:
  /// exponent >= 0; 1 is the cosine lobe.
  explicit Lobe(double exponent);

  double exponent() const { return exponent_; }

  /// Density, 1/sr, at cos_alpha from the axis, before the cut.
  double density(double cos_alpha) const { return cos_alpha > 0 ? peak_ * power(cos_alpha) : 0; }

  /// Returns the share of the lobe on the axis's side of the wall, in [1/2, 1]; cos_axis in [0, 1]: cosine of the axis
  /// to the wall's normal. After the cut the density is density() / kept_share(). Fast for a TabulatedLobe only.
  double kept_share(double cos_axis) const { return table_ ? table_->at(cos_axis) : integrate_kept_share(cos_axis); }

  /// Quantiles of the directions after the cut; nullptr unless this is a CutLobe.
  const LobeQuantiles* quantiles() const { return quantiles_; }

  /// Cosine to the axis from one uniform number, before the cut.
  float cos_from_uniform(float uniform) const { return std::pow(uniform, static_cast<float>(1 / (exponent_ + 1))); }
  /// The same, faster but not monotonic in `uniform`; further random numbers are taken from `rng`.
  double sample_cos(double uniform, RandomStream& rng) const {
    if (maxima_ == 0) return std::pow(uniform, 1 / (exponent_ + 1));
    // The k-th root of a uniform number is distributed like the largest of k of them, which costs less than pow.
    for (int left = maxima_ - 1; left > 0; left -= 2) {
      const uint64_t bits = rng.bits();
      uniform = std::max(uniform, static_cast<double>(bits >> 32) * 0x1p-32);
      if (left > 1) uniform = std::max(uniform, static_cast<double>(bits & 0xffffffff) * 0x1p-32);
    }
    return std::sqrt(uniform);
  }

 protected:
  /// `kept_share` at even steps of x = sqrt(1 - cos_axis).
  class KeptTable {
   public:
    explicit KeptTable(double exponent);
    double at(double cos_axis) const {
      const double x = std::sqrt(std::max(0.0, 1 - cos_axis)) * kCells;
      const auto cell = std::min(static_cast<size_t>(x), kCells - 1);
      const double t = x - static_cast<double>(cell);
      const Node &a = nodes_[cell], &b = nodes_[cell + 1];
      const double rise = b.value - a.value;
      // Cubic Hermite interpolation; slopes are per cell.
      return a.value + t * (a.slope + t * (3 * rise - 2 * a.slope - b.slope + t * (a.slope + b.slope - 2 * rise)));
    }

   private:
    struct Node {
      double value, slope;
    };
    static constexpr size_t kCells = 256;
    std::array<Node, kCells + 1> nodes_;
  };

  Lobe(double exponent, const KeptTable* table) : Lobe(exponent) { table_ = table; }

  const LobeQuantiles* quantiles_ = nullptr;  ///< not owned

 private:
  double integrate_kept_share(double cos_axis) const;
  double power(double c) const {
    if (whole_ < 0) return std::pow(c, exponent_);
    double result = 1;
    for (int bits = whole_; bits > 0; bits >>= 1, c *= c)
      if (bits & 1) result *= c;
    return result;
  }

  double exponent_;
  double peak_;                       ///< density on the axis
  int whole_;                         ///< the exponent where it is a small whole number, else -1
  int maxima_;                        ///< (e + 1) / 2 for small odd exponents, else 0
  const KeptTable* table_ = nullptr;  ///< not owned
};

/// A lobe with a table of `kept_share`, for frequent calls. Copies as a plain Lobe must not outlive it.
class TabulatedLobe : public Lobe {
 public:
  explicit TabulatedLobe(double exponent) : TabulatedLobe(exponent, std::make_shared<const KeptTable>(exponent)) {}

 private:
  TabulatedLobe(double exponent, std::shared_ptr<const KeptTable> table)
      : Lobe(exponent, table.get()), table_(std::move(table)) {}

  std::shared_ptr<const KeptTable> table_;
};

/// A lobe with a table of quantiles, for drawing many directions after the cut.
class CutLobe final : public TabulatedLobe {
 public:
  explicit CutLobe(double exponent) : TabulatedLobe(exponent), owned_(std::make_shared<const LobeQuantiles>(exponent)) {
    quantiles_ = owned_.get();
  }

 private:
  std::shared_ptr<const LobeQuantiles> owned_;
};

}  // namespace frond::leaf
