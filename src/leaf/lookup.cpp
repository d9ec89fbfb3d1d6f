#include "leaf/lookup.h"

#include <cassert>
#include <numbers>
#include <optional>

#include "leaf/monotone_cubic.h"

namespace frond::leaf {
namespace {

/// One side of the leaf at one wavelength.
class Side {
 public:
  Side(const Table& table, size_t wavelength, bool abaxial) {
    const bool mirrored = abaxial && !table.has_equal_sides();
    std::vector<double> theta, surface, subsurface, transmitted;
    for (size_t k = 0; k < table.theta_deg.size(); ++k) {
      const size_t i = mirrored ? table.theta_deg.size() - 1 - k : k;
      const double from_normal = mirrored ? 180 - table.theta_deg[i] : table.theta_deg[i];
      if (from_normal > 90) break;
      const Shares& s = table.at(wavelength, i);
      theta.push_back(from_normal);
      surface.push_back(s.surface);
      subsurface.push_back(s.subsurface);
      transmitted.push_back(s.transmitted);
    }
    surface_.emplace(theta, std::move(surface));
    subsurface_.emplace(theta, std::move(subsurface));
    transmitted_.emplace(theta, std::move(transmitted));
  }

  /// theta_deg from this side's normal.
  Shares at(double theta_deg) const {
    return {(*surface_)(theta_deg), (*subsurface_)(theta_deg), (*transmitted_)(theta_deg)};
  }

 private:
  std::optional<MonotoneCubic> surface_, subsurface_, transmitted_;
};

/// Each share stays between its neighbours in the table; their sum may pass 1 by a little, and energy may not.
Shares within_bounds(const Shares& s) {
  const double scale = 1 / std::max(1.0, s.surface + s.subsurface + s.transmitted);
  return {s.surface * scale, s.subsurface * scale, s.transmitted * scale};
}

}  // namespace

std::vector<TableLookup::Node> TableLookup::resample(const Table& table, size_t wavelength) {
  std::vector<Node> nodes;
  for (const bool abaxial : {false, true}) {
    const Side side(table, wavelength, abaxial);
    for (size_t i = 0; i <= kCells; ++i) {
      const double x = static_cast<double>(i) / kCells;
      const Shares s = within_bounds(side.at(std::acos(x * x) * 180 / std::numbers::pi));
      nodes.push_back(
          {static_cast<float>(s.surface), static_cast<float>(s.subsurface), static_cast<float>(s.transmitted), 0});
    }
  }
  return nodes;
}

TableLookup TableLookup::for_lanes(const Table& table) {
  assert(table.wavelengths_nm.size() <= kLanes);
  TableLookup lookup;
  lookup.lanes_.resize(kNodes);
  for (size_t lane = 0; lane < table.wavelengths_nm.size(); ++lane) {
    const std::vector<Node> nodes = resample(table, lane);
    for (size_t i = 0; i < kNodes; ++i) {
      lookup.lanes_[i].surface.v[lane] = nodes[i].surface;
      lookup.lanes_[i].subsurface.v[lane] = nodes[i].subsurface;
      lookup.lanes_[i].transmitted.v[lane] = nodes[i].transmitted;
    }
  }
  return lookup;
}

TableLookup TableLookup::for_spectra(const Table& table) {
  const size_t count = table.wavelengths_nm.size();
  assert(count > 1);
  TableLookup lookup;
  lookup.nm_.assign(table.wavelengths_nm.begin(), table.wavelengths_nm.end());
  lookup.index_wavelengths();
  lookup.spectra_.resize(kNodes * count);
  for (size_t w = 0; w < count; ++w) {
    const std::vector<Node> nodes = resample(table, w);
    for (size_t i = 0; i < kNodes; ++i) lookup.spectra_[i * count + w] = nodes[i];
  }
  return lookup;
}

/// Bins about as narrow as the closest wavelengths: then few steps are left from a bin's beginning.
void TableLookup::index_wavelengths() {
  constexpr float kMostBins = 1 << 16;
  const float range = nm_.back() - nm_.front();
  float narrowest = range;
  for (size_t i = 1; i < nm_.size(); ++i) narrowest = std::min(narrowest, nm_[i] - nm_[i - 1]);
  const float bins = narrowest > 0 ? std::min(std::ceil(range / narrowest), kMostBins) : kMostBins;
  bins_per_nm_ = bins / range;
  last_bin_ = bins - 1;
  for (uint32_t bin = 0, below = 0; bin <= static_cast<uint32_t>(last_bin_); ++bin) {
    const float begin = nm_[0] + static_cast<float>(bin) / bins_per_nm_;
    while (below + 2 < nm_.size() && nm_[below + 1] <= begin) ++below;
    first_in_bin_.push_back(below);
  }
}

SampledShares TableLookup::between_wavelengths(size_t node, float t, const SampledWavelengths& lambda) const {
  SampledShares shares;
  for (int lane = 0; lane < lambda.count; ++lane) {
    const float nm = lambda.nm[static_cast<size_t>(lane)];
    const size_t below = wavelength_below(nm);
    const float s = std::clamp((nm - nm_[below]) / (nm_[below + 1] - nm_[below]), 0.f, 1.f);
    const Node *a = &spectra_[node * nm_.size() + below], *b = a + nm_.size();
    const auto bilinear = [&](float Node::*value) {
      const float near = a[0].*value * (1 - s) + a[1].*value * s, far = b[0].*value * (1 - s) + b[1].*value * s;
      return near * (1 - t) + far * t;
    };
    shares.surface[lane] = bilinear(&Node::surface);
    shares.subsurface[lane] = bilinear(&Node::subsurface);
    shares.transmitted[lane] = bilinear(&Node::transmitted);
  }
  return shares;
}

}  // namespace frond::leaf
