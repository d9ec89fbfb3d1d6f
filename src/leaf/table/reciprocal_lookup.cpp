#include "leaf/table/reciprocal_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "leaf/solve/quadrature.h"
#include "leaf/table/lobe_scaler.h"

namespace frond::leaf {
namespace {

constexpr size_t kNodes = TableLookup::kNodes, kSide = TableLookup::kCells + 1;
using ShareColumn = std::array<Shares, kNodes>;

/// Cosines of the nodes of a side.
std::vector<double> node_cosines() {
  std::vector<double> cosines;
  for (size_t k = 0; k < kSide; ++k) {
    const double x = static_cast<double>(k) / static_cast<double>(TableLookup::kCells);
    cosines.push_back(x * x);
  }
  return cosines;
}

/// Weights of the nodes of a side in 2 int ... cos theta sin theta dtheta: the mean under diffuse light.
const std::array<double, kSide>& mean_weights() {
  static const auto weights = [] {
    std::array<double, kSide> w{};
    constexpr double kWidth = 1.0 / static_cast<double>(TableLookup::kCells);
    for (size_t cell = 0; cell + 1 < kSide; ++cell)
      for (const auto& [t, weight] : gauss_legendre(3)) {
        const double x = (static_cast<double>(cell) + t) * kWidth, whole = weight * kWidth * 4 * x * x * x;
        w[cell] += whole * (1 - t), w[cell + 1] += whole * t;
      }
    return w;
  }();
  return weights;
}

template <class Value>
std::array<double, 2> means(const Value& value) {
  std::array<double, 2> sums{};
  for (size_t i = 0; i < kNodes; ++i) sums[i / kSide] += mean_weights()[i % kSide] * value(i);
  return sums;
}

/// d, and the share of Rd + T that leaves on the side of incidence.
struct SubsurfaceFactors {
  std::array<double, kNodes> d, back;
};

/// Given the means over a side of d, d Rd and d T, d follows from Rd and T at each direction.
SubsurfaceFactors subsurface_factors(const ShareColumn& column) {
  constexpr int kMostSteps = 500;
  constexpr double kDone = 1e-13;
  SubsurfaceFactors factors;
  auto& d = factors.d;
  auto& back = factors.back;
  d.fill(1), back.fill(0);
  for (int step = 0; step < kMostSteps; ++step) {
    const auto all = means([&](size_t i) { return d[i]; });
    const auto reflected = means([&](size_t i) { return d[i] * column[i].subsurface; });
    const auto transmitted = means([&](size_t i) { return d[i] * column[i].transmitted; });
    double off = 0;
    for (size_t i = 0; i < kNodes; ++i) {
      const size_t here = i / kSide, there = 1 - here;
      const double r = column[i].subsurface, t = column[i].transmitted;
      const double returns = (r * all[here] + reflected[here]) / 2, passes = (t * all[there] + transmitted[there]) / 2;
      if (!(returns + passes > 0) || !(r + t > 0)) {  // black, or at grazing
        d[i] = back[i] = 0;
        continue;
      }
      off = std::max(off, std::abs(d[i] * (returns + passes) / (r + t) - 1));
      d[i] = std::sqrt(d[i] * (r + t) / (returns + passes));
      back[i] = d[i] * returns;
    }
    if (off < kDone) break;
  }
  return factors;
}

/// s on one side.
std::vector<double> surface_factors(LobeScaler& lobe, const ShareColumn& column, size_t first) {
  const auto reflectance = [&](double cos_theta) {
    const auto [node, t] = TableLookup::position(static_cast<float>(cos_theta));
    return std::lerp(column[first + node].surface, column[first + node + 1].surface, static_cast<double>(t));
  };
  std::vector<double> factors = lobe(reflectance);
  for (size_t k = 0; k < kSide; ++k) factors[k] = column[first + k].surface / factors[k];
  return factors;
}

/// Whether two sides have the same Rs.
bool equal_surfaces(const Shares* a, const Shares* b) {
  return std::equal(a, a + kSide, b, [](const Shares& x, const Shares& y) { return x.surface == y.surface; });
}

/// From [row][lane][node] to [row][node].
std::vector<Float4> by_lanes(const std::vector<float>& values) {
  std::vector<Float4> result(values.size() / kLanes);
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t row = i / (kLanes * kNodes), lane = i / kNodes % kLanes;
    result[row * kNodes + i % kNodes][lane] = values[i];
  }
  return result;
}

}  // namespace

ReciprocalLookup::ReciprocalLookup(const TableLookup& shares, const Interval& exponents)
    : axis_(exponents), columns_(shares.columns()) {
  std::vector<ShareColumn> columns(columns_);
  for (size_t c = 0; c < columns_; ++c) {
    for (size_t i = 0; i < kNodes; ++i) columns[c][i] = shares.shares(c, i);
    const SubsurfaceFactors subsurface = subsurface_factors(columns[c]);
    subsurface_.insert(subsurface_.end(), subsurface.d.begin(), subsurface.d.end());
    back_.insert(back_.end(), subsurface.back.begin(), subsurface.back.end());
  }
  for (const double exponent : axis_.exponents()) {
    LobeScaler lobe(exponent, node_cosines());
    const Shares* last = nullptr;  // the side that `factors` are for: depths, and mostly both sides, share one surface
    std::vector<double> factors;
    for (const ShareColumn& column : columns)
      for (const size_t first : {size_t{0}, kSide}) {
        if (!last || !equal_surfaces(last, &column[first])) factors = surface_factors(lobe, column, first);
        last = &column[first];
        surface_.insert(surface_.end(), factors.begin(), factors.end());
      }
  }
  if (columns_ != kLanes) return;
  surface_lanes_ = by_lanes(surface_), subsurface_lanes_ = by_lanes(subsurface_), back_lanes_ = by_lanes(back_);
}

ReciprocalLookup::Factors ReciprocalLookup::sum_columns(size_t node, float t, const Position& exponent,
                                                        const TableSelection& selection) const {
  Factors f;
  for (int lane = 0; lane < selection.lane_count; ++lane) {
    const TableSelection::Lane& at = selection.lanes[static_cast<size_t>(lane)];
    for (size_t i = 0; i < static_cast<size_t>(selection.columns_per_lane); ++i) {
      const size_t c = at.column[i];
      const float below = interpolate(surface_, exponent.below * columns_ + c, node, t),
                  above = interpolate(surface_, exponent.above * columns_ + c, node, t);
      f.surface[lane] += at.weight[i] * (below + exponent.t * (above - below));
      f.subsurface[lane] += at.weight[i] * interpolate(subsurface_, c, node, t);
      f.back[lane] += at.weight[i] * interpolate(back_, c, node, t);
    }
  }
  return f;
}

}  // namespace frond::leaf
