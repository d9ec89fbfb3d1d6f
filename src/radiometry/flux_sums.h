#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "core/math/exact_sum.h"
#include "core/spectrum.h"
#include "instruments/errors/statistics.h"

namespace frond {

/// Index of a quantity of FluxMeter in a path's row. Three quantities for each material follow, then two for each of
/// FluxLeaves.
enum FluxQuantity : size_t { kReflected, kTransmitted, kTotal, kFirstOfMaterials };
enum FluxOfMaterial : size_t { kAbsorbed, kIncident, kUncollided, kQuantitiesOfMaterial };

inline size_t flux_quantity(size_t material, FluxOfMaterial quantity) {
  return kFirstOfMaterials + material * kQuantitiesOfMaterial + quantity;
}

/// Leaf surfaces, of which the absorbed and the incident light is measured.
enum FluxLeaves : size_t { kAllLeaves, kSunlitLeaves, kShadedLeaves, kLeafGroups };

inline size_t leaf_quantity(size_t materials, FluxLeaves leaves, FluxOfMaterial quantity) {
  return flux_quantity(materials, kAbsorbed) + leaves * 2 + quantity;
}

/// Channels of a quantity: one for each band, or four.
struct FluxChannels {
  size_t bands;
  bool splits;  ///< whether direct and diffuse light, energy and photons have channels of their own

  size_t count() const { return splits ? 4 * bands : bands; }
  /// Channel of the energy. Without splitting, that of all light.
  size_t energy(size_t band, bool is_direct) const { return splits ? 4 * band + (is_direct ? 0 : 1) : band; }
  size_t photons(size_t band, bool is_direct) const { return 4 * band + (is_direct ? 2 : 3); }
};

/// One path's shares of the incident light by quantity, lane by lane.
class FluxShares {
 public:
  explicit FluxShares(size_t quantities) : values_(quantities) {}
  void clear() {
    std::ranges::fill(values_, SampledSpectrum());
    organs_.clear();
  }
  void add(size_t quantity, const SampledSpectrum& share) { values_[quantity] += share; }
  /// Adds light that is absorbed or leaves the scene.
  void add_end(size_t quantity, const SampledSpectrum& share) {
    add(quantity, share);
    add(kTotal, share);
  }
  /// Light that falls on an organ and that it absorbs.
  struct OfOrgan {
    uint64_t organ;
    SampledSpectrum incident, absorbed;
  };
  /// `organ`: number of the organ that absorbs, of the incident light; 0: none.
  void add_absorbed(uint32_t material, uint64_t organ, const SampledSpectrum& incident, const SampledSpectrum& share) {
    add_end(flux_quantity(material, kAbsorbed), share);
    if (organ == 0) return;
    const auto known = std::ranges::find(organs_, organ, &OfOrgan::organ);
    if (known == organs_.end())
      organs_.push_back({organ, incident, share});
    else
      known->incident += incident, known->absorbed += share;
  }
  const std::vector<SampledSpectrum>& values() const { return values_; }
  const std::vector<OfOrgan>& organs() const { return organs_; }

 private:
  std::vector<SampledSpectrum> values_;
  std::vector<OfOrgan> organs_;
};

/// Sum and sum of squares over paths.
struct Moment {
  double sum = 0, square = 0;
  void add(double x) { sum += x, square += x * x; }
  Moment& operator+=(const Moment& other) {
    sum += other.sum, square += other.square;
    return *this;
  }
  /// Moment of the sum of two values of which each path has at most one.
  friend Moment operator+(Moment a, const Moment& b) { return a += b; }
  MeanError mean(uint64_t paths) const {
    const auto n = double(paths);
    if (paths == 0) return {};
    const double mean = sum / n, variance = std::max(0.0, square / n - mean * mean);
    return {mean, paths > 1 ? std::sqrt(variance / (n - 1)) : 0};
  }
};

/// Adds numbers that are stored as bytes to as many others.
template <class T>
void add_elements(std::span<T> to, std::span<const std::byte> bytes) {
  for (size_t i = 0; i < to.size(); ++i) {
    T number;
    std::memcpy(static_cast<void*>(&number), bytes.data() + i * sizeof number, sizeof number);
    to[i] += number;
  }
}

/// Sum of the moments of blocks of paths. It is exact, so that it does not depend on the order of the blocks, or on how
/// they are divided among parts of a measurement.
class ExactMoment {
 public:
  void add(const Moment& block) {
    const bool fits = block.sum < sum_.kLargestTerm && block.square < square_.kLargestTerm;  // false for NaN
    if (!fits) ++lost_;
    if (fits) sum_.add(block.sum), square_.add(block.square);
  }
  ExactMoment& operator+=(const ExactMoment& other) {
    sum_ += other.sum_, square_ += other.square_, lost_ += other.lost_;
    return *this;
  }
  /// NaN if a block had a value that is not finite.
  Moment value() const { return lost_ == 0 ? Moment{sum_.value(), square_.value()} : Moment{NAN, NAN}; }

 private:
  ExactSum<60> sum_;
  ExactSum<40> square_;
  Int128 lost_ = 0;  ///< number of blocks that do not count; as wide as the others, so that there is no padding
};

/// Moments of organs, which all threads add to. They are integers, so that the sum does not depend on the order.
class OrganSums {
 public:
  OrganSums(uint64_t organs, size_t channels) : channels_(channels), cells_(organs * channels) {}
  void add(uint64_t organ, size_t channel, double share) {
    Cell& cell = cells_[(organ - 1) * channels_ + channel];
    std::atomic_ref(cell.sum).fetch_add(std::llrint(share * kUnits), std::memory_order_relaxed);
    const double square = std::min(share * share, kLargestSquare);
    std::atomic_ref(cell.square).fetch_add(std::llrint(square * kUnits), std::memory_order_relaxed);
  }
  size_t size() const { return cells_.size(); }
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(cells_)); }
  /// Adds the sums of other paths, which bytes() has returned.
  void add(std::span<const std::byte> bytes) { add_elements(std::span(&cells_.front().sum, 2 * cells_.size()), bytes); }
  Moment at(size_t cell) const { return {double(cells_[cell].sum) / kUnits, double(cells_[cell].square) / kUnits}; }

  static constexpr size_t kCellBytes = 16;

 private:
  static constexpr double kUnits = 0x1p36;
  static constexpr double kLargestSquare = 0x1p20;  ///< light from the horizon has large weights: 64 bits suffice
  struct Cell {
    int64_t sum = 0, square = 0;
  };
  size_t channels_;
  std::vector<Cell> cells_;
};

}  // namespace frond
