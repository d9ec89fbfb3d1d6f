#pragma once

#include <cstdint>

#include "core/spectrum.h"
#include "leaf/table.h"

namespace frond::leaf {

/// Rs, Rd and T lane by lane.
struct SampledShares {
  SampledSpectrum surface, subsurface, transmitted;
};

/// A table made ready for the render loop: linear between nodes that are even in sqrt |cos theta|, where they are dense
/// toward grazing and need no arc cosine. The table's degrees are carried over to the nodes by cubic interpolation.
class TableLookup {
 public:
  TableLookup() = default;
  /// Lanes of paths are the table's wavelengths, one by one; at most kLanes.
  static TableLookup for_lanes(const Table& table);
  /// Lanes are anywhere between the table's wavelengths, which are evenly spaced.
  static TableLookup for_spectra(const Table& table);

  /// cos_theta in [-1, 1], of the traced ray's origin to the adaxial normal. Lanes not in use: undefined.
  SampledShares operator()(float cos_theta, const SampledWavelengths& lambda) const {
    const float x = std::sqrt(std::min(std::abs(cos_theta), 1.f)) * kCells;
    const auto cell = std::min(static_cast<size_t>(x), kCells - 1);
    const float t = x - static_cast<float>(cell);
    const size_t node = (cos_theta < 0 ? kCells + 1 : 0) + cell;
    if (step_nm_ == 0) return mix(lanes_[node], lanes_[node + 1], t);
    return between_wavelengths(node, t, lambda);
  }

 private:
  static constexpr size_t kCells = 128;
  static constexpr size_t kNodes = 2 * (kCells + 1);  ///< adaxial side, then abaxial, each from grazing to the normal

  /// One wavelength at one node, padded to a vector.
  struct alignas(16) Node {
    float surface, subsurface, transmitted, pad;
  };

  static Node resample(const Table& table, size_t wavelength, size_t node);
  static SampledShares mix(const SampledShares& a, const SampledShares& b, float t) {
    const float s = 1 - t;
    return {a.surface * s + b.surface * t, a.subsurface * s + b.subsurface * t, a.transmitted * s + b.transmitted * t};
  }
  SampledShares between_wavelengths(size_t node, float t, const SampledWavelengths& lambda) const;

  std::vector<SampledShares> lanes_;  ///< [node]
  std::vector<Node> spectra_;         ///< [node][wavelength]
  size_t wavelengths_ = 0;
  float first_nm_ = 0, step_nm_ = 0;  ///< step 0: lanes
};

}  // namespace frond::leaf
