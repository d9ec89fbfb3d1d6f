#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
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

/// Light by where it came from. The paths of a pair may differ in it: all light has sums of its own.
enum LightPart : size_t { kAllLight, kDirectLight, kDiffuseLight, kLightParts };

/// Channels of a quantity: one for each band, or six.
struct FluxChannels {
  size_t bands;
  bool splits;  ///< whether energy and photons, each of all, direct and diffuse light, have channels of their own

  size_t count() const { return splits ? 2 * kLightParts * bands : bands; }
  /// Channel of the energy. Without splitting, there is that of all light.
  size_t energy(size_t band, LightPart part) const { return splits ? 2 * kLightParts * band + part : band; }
  size_t photons(size_t band, LightPart part) const { return (2 * band + 1) * kLightParts + part; }
};

/// Channels of an organ in a band, where direct light, energy and photons are apart.
enum OrganChannel : size_t {
  kOrganEnergy,
  kOrganDirect,
  kOrganPhotons,
  kOrganIncident,
  kOrganIncidentPhotons,
  kOrganChannels
};

/// Factor on incident light in these sums: light that white surfaces return again and again would exceed their range.
constexpr double kIncidentScale = 0x1p-8;

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
  struct Light {
    SampledSpectrum incident, absorbed;
  };
  struct OfOrgan {
    uint64_t organ;
    Light light;
  };
  /// `organ`: number of the organ that absorbs, of the incident light; 0: none.
  void add_absorbed(uint32_t material, uint64_t organ, const SampledSpectrum& incident, const SampledSpectrum& share) {
    add_end(flux_quantity(material, kAbsorbed), share);
    if (organ == 0) return;
    const auto known = std::ranges::find(organs_, organ, &OfOrgan::organ);
    if (known == organs_.end())
      organs_.push_back({organ, {incident, share}});
    else
      known->light.incident += incident, known->light.absorbed += share;
  }
  const std::vector<SampledSpectrum>& values() const { return values_; }
  const std::vector<OfOrgan>& organs() const { return organs_; }

 private:
  std::vector<SampledSpectrum> values_;
  std::vector<OfOrgan> organs_;
};

/// Sum over pairs of paths, with that of the squared differences within pairs, which estimate the variance without
/// bias, however the strata differ.
struct Moment {
  double sum = 0, square = 0;
  Moment& operator+=(const Moment& other) {
    sum += other.sum, square += other.square;
    return *this;
  }
  MeanError mean(uint64_t paths) const {
    if (paths == 0) return {};
    return {sum / double(paths), std::sqrt(square) / double(paths)};
  }
};

/// Shares of the two paths of a pair, or factors on them.
struct PairShare {
  double first = 0, second = 0;
  PairShare operator*(const PairShare& b) const { return {first * b.first, second * b.second}; }
  PairShare operator*(double factor) const { return {first * factor, second * factor}; }
  bool is_zero() const { return first == 0 && second == 0; }
  Moment moment() const { return {first + second, (first - second) * (first - second)}; }
};

/// Calls act(organ, its light of the first path, its light of the second path) for each organ that either has met.
template <class Act>
void visit_organs(const FluxShares& first, const FluxShares& second, const Act& act) {
  using OfOrgan = FluxShares::OfOrgan;
  const auto &a = first.organs(), &b = second.organs();
  for (const OfOrgan& o : a) {
    const auto other = std::ranges::find(b, o.organ, &OfOrgan::organ);
    act(o.organ, o.light, other == b.end() ? FluxShares::Light() : other->light);
  }
  for (const OfOrgan& o : b)
    if (std::ranges::find(a, o.organ, &OfOrgan::organ) == a.end()) act(o.organ, FluxShares::Light(), o.light);
}

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
  /// Adds what a pair of paths has brought.
  void add(uint64_t organ, size_t channel, const Moment& share) {
    Cell& cell = cells_[(organ - 1) * channels_ + channel];
    add(cell.sum, share.sum);
    add(cell.square, std::min(share.square, kLargestSquare));
  }
  size_t size() const { return cells_.size(); }
  /// Throws InputError if a sum has exceeded its range, as do all that read the sums.
  std::span<const std::byte> bytes() const {
    check();
    return std::as_bytes(std::span(cells_));
  }
  /// Adds the sums of other paths, which bytes() has returned.
  void add(std::span<const std::byte> bytes) {
    const std::span sums(&cells_.front().sum, 2 * cells_.size());
    add_elements(sums, bytes);
    if (std::ranges::any_of(sums, [](int64_t sum) { return sum < 0 || sum >= kFull; })) is_full_ = true;
  }
  Moment at(size_t cell) const {
    check();
    return {double(cells_[cell].sum) / kUnits, double(cells_[cell].square) / kUnits};
  }

  static constexpr size_t kCellBytes = 16;

 private:
  static constexpr double kUnits = 0x1p36;
  static constexpr double kLargestSquare = 0x1p20;  ///< of a term: light from the horizon has large weights
  static constexpr int64_t kFull = int64_t{1} << 62;
  struct Cell {
    int64_t sum = 0, square = 0;
  };

  void add(int64_t& sum, double term) {
    const double units = term * kUnits;
    if (!(units < double(kFull)) ||
        std::atomic_ref(sum).fetch_add(std::llrint(units), std::memory_order_relaxed) >= kFull)
      is_full_ = true;
  }
  void check() const {
    if (is_full_)
      fail({},
           "the light of so many paths exceeds the sums of single organs, which hold {:.2g} paths that one organ "
           "absorbs: take fewer paths",
           double(kFull) / kUnits);
  }

  size_t channels_;
  std::vector<Cell> cells_;
  std::atomic<bool> is_full_ = false;
};

}  // namespace frond
