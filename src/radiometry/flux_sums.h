#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

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
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
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
