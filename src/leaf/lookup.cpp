#include "leaf/lookup.h"

#include <cassert>
#include <numbers>

namespace frond::leaf {
namespace {

/// Cubic through the four degrees nearest to theta_deg, on one side of the leaf: first and last are its degrees.
Shares interpolate(const Table& table, size_t wavelength, double theta_deg, size_t first, size_t last) {
  const auto cell = static_cast<size_t>(theta_deg);
  const size_t start = std::clamp(cell > 0 ? cell - 1 : 0, first, last - 3);
  const double t = theta_deg - static_cast<double>(start);
  const std::array<double, 4> weights{-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2,
                                      -t * (t - 1) * (t - 3) / 2, t * (t - 1) * (t - 2) / 6};
  Shares sum;
  for (size_t i = 0; i < 4; ++i) {
    const Shares& s = table.at(wavelength, start + i);
    sum.surface += weights[i] * s.surface;
    sum.subsurface += weights[i] * s.subsurface;
    sum.transmitted += weights[i] * s.transmitted;
  }
  return sum;
}

/// Interpolation may overshoot by a little; shares may not.
Shares within_bounds(const Shares& s) {
  Shares r{std::max(0.0, s.surface), std::max(0.0, s.subsurface), std::max(0.0, s.transmitted)};
  const double scale = 1 / std::max(1.0, r.surface + r.subsurface + r.transmitted);
  return {r.surface * scale, r.subsurface * scale, r.transmitted * scale};
}

}  // namespace

TableLookup::Node TableLookup::resample(const Table& table, size_t wavelength, size_t node) {
  const bool abaxial = node > kCells;
  const double x = static_cast<double>(node % (kCells + 1)) / kCells;
  const double from_normal = std::acos(x * x) * 180 / std::numbers::pi;
  const Shares s = within_bounds(abaxial ? interpolate(table, wavelength, 180 - from_normal, 90, 180)
                                         : interpolate(table, wavelength, from_normal, 0, 90));
  return {static_cast<float>(s.surface), static_cast<float>(s.subsurface), static_cast<float>(s.transmitted), 0};
}

TableLookup TableLookup::for_lanes(const Table& table) {
  assert(table.wavelengths_nm.size() <= kLanes);
  TableLookup lookup;
  lookup.lanes_.resize(kNodes);
  for (size_t node = 0; node < kNodes; ++node)
    for (size_t lane = 0; lane < table.wavelengths_nm.size(); ++lane) {
      const Node n = resample(table, lane, node);
      lookup.lanes_[node].surface.v[lane] = n.surface;
      lookup.lanes_[node].subsurface.v[lane] = n.subsurface;
      lookup.lanes_[node].transmitted.v[lane] = n.transmitted;
    }
  return lookup;
}

TableLookup TableLookup::for_spectra(const Table& table) {
  assert(table.wavelengths_nm.size() > 1);
  TableLookup lookup;
  lookup.wavelengths_ = table.wavelengths_nm.size();
  lookup.first_nm_ = static_cast<float>(table.wavelengths_nm[0]);
  lookup.step_nm_ = static_cast<float>(table.wavelengths_nm[1] - table.wavelengths_nm[0]);
  lookup.spectra_.reserve(kNodes * lookup.wavelengths_);
  for (size_t node = 0; node < kNodes; ++node)
    for (size_t w = 0; w < lookup.wavelengths_; ++w) lookup.spectra_.push_back(resample(table, w, node));
  return lookup;
}

SampledShares TableLookup::between_wavelengths(size_t node, float t, const SampledWavelengths& lambda) const {
  SampledShares shares;
  for (int lane = 0; lane < lambda.count; ++lane) {
    const float w = std::max(0.f, (lambda.nm[static_cast<size_t>(lane)] - first_nm_) / step_nm_);
    const auto below = std::min(static_cast<size_t>(w), wavelengths_ - 2);
    const float s = std::min(w - static_cast<float>(below), 1.f);
    const Node *a = &spectra_[node * wavelengths_ + below], *b = a + wavelengths_;
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
