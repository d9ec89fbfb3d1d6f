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

/// Index of a quantity of FluxMeter in a path's row. Three quantities for each material follow.
enum FluxQuantity : size_t { kReflected, kTransmitted, kTotal, kFirstOfMaterials };
enum FluxOfMaterial : size_t { kAbsorbed, kIncident, kUncollided, kQuantitiesOfMaterial };

inline size_t flux_quantity(size_t material, FluxOfMaterial quantity) {
  return kFirstOfMaterials + material * kQuantitiesOfMaterial + quantity;
}

/// One path's shares of the incident light by quantity, lane by lane.
class FluxShares {
 public:
  explicit FluxShares(size_t quantities) : values_(quantities) {}
  void clear() {
    std::ranges::fill(values_, SampledSpectrum());
    absorbed_.clear();
  }
  void add(size_t quantity, const SampledSpectrum& share) { values_[quantity] += share; }
  /// Adds light that is absorbed or leaves the scene.
  void add_end(size_t quantity, const SampledSpectrum& share) {
    add(quantity, share);
    add(kTotal, share);
  }
  /// `instance`: SurfacePoint::instance_id.
  void add_absorbed(uint32_t material, uint64_t instance, const SampledSpectrum& share) {
    add_end(flux_quantity(material, kAbsorbed), share);
    if (instance == 0) return;
    const auto known = std::ranges::find(absorbed_, instance, &std::pair<uint64_t, SampledSpectrum>::first);
    if (known == absorbed_.end())
      absorbed_.emplace_back(instance, share);
    else
      known->second += share;
  }
  const std::vector<SampledSpectrum>& values() const { return values_; }
  const std::vector<std::pair<uint64_t, SampledSpectrum>>& absorbed_by_instance() const { return absorbed_; }

 private:
  std::vector<SampledSpectrum> values_;
  std::vector<std::pair<uint64_t, SampledSpectrum>> absorbed_;
};

/// Sum and sum of squares over paths.
struct Moment {
  double sum = 0, square = 0;
  void add(double x) { sum += x, square += x * x; }
  Moment& operator+=(const Moment& other) {
    sum += other.sum, square += other.square;
    return *this;
  }
  MeanError mean(uint64_t paths) const {
    const auto n = double(paths);
    if (paths == 0) return {};
    const double mean = sum / n, variance = std::max(0.0, square / n - mean * mean);
    return {mean, paths > 1 ? std::sqrt(variance / (n - 1)) : 0};
  }
};

/// Moments of instances, which all threads add to. They are integers, so that the sum does not depend on the order.
class InstanceSums {
 public:
  InstanceSums(uint64_t instances, size_t bands) : bands_(bands), cells_(instances * bands) {}
  void add(uint64_t instance, size_t band, double share) {
    Cell& cell = cells_[(instance - 1) * bands_ + band];
    std::atomic_ref(cell.sum).fetch_add(std::llrint(share * kUnits), std::memory_order_relaxed);
    std::atomic_ref(cell.square).fetch_add(std::llrint(share * share * kUnits), std::memory_order_relaxed);
  }
  size_t size() const { return cells_.size(); }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
  Moment at(size_t cell) const { return {double(cells_[cell].sum) / kUnits, double(cells_[cell].square) / kUnits}; }

  static constexpr size_t kCellBytes = 16;

 private:
  static constexpr double kUnits = 0x1p36;
  struct Cell {
    int64_t sum = 0, square = 0;
  };
  size_t bands_;
  std::vector<Cell> cells_;
};

}  // namespace frond
