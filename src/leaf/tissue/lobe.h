#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/random.h"
#include "leaf/tissue/lobe_quantiles.h"

namespace frond::leaf {

/// How a rough cell wall spreads light around an ideal direction: density proportional to cos^e of the angle to it
/// (Lafortune and Willems 1994; eq. 2 of Baranoski and Rokne 1998), cut off at the plane of the wall by drawing again.
class Lobe {
 public:
  /// exponent >= 0; 1 is the cosine lobe.
  explicit Lobe(double exponent);

  double exponent() const { return exponent_; }

  /// 1/sr at cos_alpha from the axis, before the cut.
  double density(double cos_alpha) const { return cos_alpha > 0 ? peak_ * power(cos_alpha) : 0; }

  /// Share of the lobe on its axis's side of the wall, in [1/2, 1]; cos_axis in [0, 1] is the axis's to the wall's
  /// normal. What is left after the cut has density() / kept(). Quick for a TabulatedLobe alone.
  double kept(double cos_axis) const { return table_ ? table_->at(cos_axis) : kept_exactly(cos_axis); }

  /// For directions after the cut; nullptr but in a CutLobe.
  const LobeQuantiles* quantiles() const { return quantiles_; }

  /// Cosine to the axis from one uniform number.
  float cos_from_uniform(float uniform) const { return std::pow(uniform, static_cast<float>(1 / (exponent_ + 1))); }
  /// The same, quicker but not monotonous: `uniform` is one uniform number, the stream gives what more is needed.
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
  /// What is kept, at x = sqrt(1 - cos_axis) in equal steps.
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
  double kept_exactly(double cos_axis) const;
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

/// A lobe that is asked often for what the cut keeps. Plain lobes that are copied from it must not outlive it.
class TabulatedLobe : public Lobe {
 public:
  explicit TabulatedLobe(double exponent) : TabulatedLobe(exponent, std::make_shared<const KeptTable>(exponent)) {}

 private:
  TabulatedLobe(double exponent, std::shared_ptr<const KeptTable> table)
      : Lobe(exponent, table.get()), table_(std::move(table)) {}

  std::shared_ptr<const KeptTable> table_;
};

/// A lobe that many directions are drawn from after the cut.
class CutLobe final : public TabulatedLobe {
 public:
  explicit CutLobe(double exponent) : TabulatedLobe(exponent), owned_(std::make_shared<const LobeQuantiles>(exponent)) {
    quantiles_ = owned_.get();
  }

 private:
  std::shared_ptr<const LobeQuantiles> owned_;
};

}  // namespace frond::leaf
