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
/// toward grazing and need no arc cosine. The table's angles are carried over to the nodes by cubic interpolation, each
/// side by its own: those up to 90 degrees and those from there on. Where these do not reach, the nearest holds.
class TableLookup {
 public:
  TableLookup() = default;
  /// Lanes of paths are the table's wavelengths, one by one; at most kLanes.
  static TableLookup for_lanes(const Table& table);
  /// Lanes are anywhere between the table's wavelengths, which are two at least, and ascend.
  static TableLookup for_spectra(const Table& table);

  /// cos_theta in [-1, 1], of the traced ray's origin to the adaxial normal. Lanes not in use: undefined.
  SampledShares operator()(float cos_theta, const SampledWavelengths& lambda) const {
    const float x = std::sqrt(std::min(std::abs(cos_theta), 1.f)) * kCells;
    const auto cell = std::min(static_cast<size_t>(x), kCells - 1);
    const float t = x - static_cast<float>(cell);
    const size_t node = (cos_theta < 0 ? kCells + 1 : 0) + cell;
    if (nm_.empty()) return mix(lanes_[node], lanes_[node + 1], t);
    return between_wavelengths(node, t, lambda);
  }

 private:
  static constexpr size_t kCells = 128;
  static constexpr size_t kNodes = 2 * (kCells + 1);  ///< adaxial side, then abaxial, each from grazing to the normal

  /// One wavelength at one node, padded to a vector.
  struct alignas(16) Node {
    float surface, subsurface, transmitted, pad;
  };

  /// [node] of one wavelength.
  static std::vector<Node> resample(const Table& table, size_t wavelength);
  static SampledShares mix(const SampledShares& a, const SampledShares& b, float t) {
    const float s = 1 - t;
    return {a.surface * s + b.surface * t, a.subsurface * s + b.subsurface * t, a.transmitted * s + b.transmitted * t};
  }
  void index_wavelengths();
  SampledShares between_wavelengths(size_t node, float t, const SampledWavelengths& lambda) const;
  /// The wavelength below, or the first but one from the end.
  size_t wavelength_below(float nm) const {
    const auto bin = static_cast<size_t>(std::clamp((nm - nm_[0]) * bins_per_nm_, 0.f, last_bin_));
    size_t below = first_in_bin_[bin];
    while (below + 2 < nm_.size() && nm >= nm_[below + 1]) ++below;
    return below;
  }

  std::vector<SampledShares> lanes_;    ///< [node]
  std::vector<Node> spectra_;           ///< [node][wavelength]
  std::vector<float> nm_;               ///< empty: lanes
  std::vector<uint32_t> first_in_bin_;  ///< wavelength below the beginning of each of many even steps
  float bins_per_nm_ = 0, last_bin_ = 0;
};

}  // namespace frond::leaf
