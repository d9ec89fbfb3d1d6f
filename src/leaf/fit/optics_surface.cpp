#include "leaf/fit/optics_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "leaf/solve/solver.h"

namespace frond::leaf {
namespace {

// Depths are even in x = log(depth + kOffset), in which R and T are smooth from no absorption to complete absorption.
constexpr double kOffset = 0.02, kDeepest = 50;

double place(double depth) { return std::log(depth + kOffset); }
double first_place() { return place(0); }
double step(size_t count) { return (place(kDeepest) - first_place()) / static_cast<double>(count - 1); }

/// Between these wavelengths the refractive indices are nearly linear, and so are R and T at one depth.
std::vector<double> index_nodes(double first_nm, double last_nm, OpticsSurface::Grade grade) {
  static constexpr double kCoarse[] = {400, 480, 610, 850, 1300, 1900, 2140, 2320},
                          kFine[] = {400,  440,  480,  515,  555,  610,  680,  760,  850,  1000,
                                     1150, 1300, 1600, 1900, 2060, 2140, 2200, 2255, 2320, 2420};
  std::vector<double> nodes{first_nm};
  constexpr double kApart = 10;
  for (const double nm : grade == OpticsSurface::Grade::fine ? std::span<const double>(kFine) : kCoarse)
    if (nm > first_nm + kApart && nm < last_nm - kApart) nodes.push_back(nm);
  if (last_nm > first_nm) nodes.push_back(last_nm);
  return nodes;
}

}  // namespace

OpticsSurface::OpticsSurface(const TissueParams& params, const std::vector<double>& theta_deg, double first_nm,
                             double last_nm, Grade grade, const ThreadPool& pool)
    : wavelengths_nm_(index_nodes(first_nm, last_nm, grade)), depth_count_(grade == Grade::fine ? 24 : 12) {
  const TissueModel model(params);
  const int nodes = grade == Grade::fine ? 4 : 3;
  nodes_.resize(theta_deg.size() * wavelengths_nm_.size() * depth_count_);
  pool.for_each(static_cast<int64_t>(wavelengths_nm_.size()), [&](int64_t index, int) {
    const auto w = static_cast<size_t>(index);
    std::vector<Tissue> tissues;
    for (size_t d = 0; d < depth_count_; ++d) {
      const double depth = std::exp(first_place() + static_cast<double>(d) * step(depth_count_)) - kOffset;
      tissues.push_back(model.at(wavelengths_nm_[w], std::max(0.0, depth), model.lobes()));
    }
    const auto shares = solve_depths(tissues, theta_deg, nodes);
    for (size_t a = 0; a < theta_deg.size(); ++a)
      for (size_t d = 0; d < depth_count_; ++d) {
        const Shares& s = shares[d][a];
        nodes_[(a * wavelengths_nm_.size() + w) * depth_count_ + d] = {s.surface + s.subsurface, s.transmitted};
      }
  });
}

OpticsSurface::Value OpticsSurface::at(size_t angle, double lambda_nm, double depth) const {
  const auto above = std::ranges::upper_bound(wavelengths_nm_, lambda_nm);
  const auto b = std::clamp<ptrdiff_t>(above - wavelengths_nm_.begin(), 1,
                                       std::max<ptrdiff_t>(1, static_cast<ptrdiff_t>(wavelengths_nm_.size()) - 1));
  const size_t high = std::min(static_cast<size_t>(b), wavelengths_nm_.size() - 1), low = static_cast<size_t>(b) - 1;
  const double width = wavelengths_nm_[high] - wavelengths_nm_[low];
  const double across = width > 0 ? std::clamp((lambda_nm - wavelengths_nm_[low]) / width, 0.0, 1.0) : 0;

  // Lagrange's cubic through four neighbours, and its slope.
  const double x = (place(std::min(depth, kDeepest)) - first_place()) / step(depth_count_);
  const auto first =
      static_cast<size_t>(std::clamp<double>(std::floor(x) - 1, 0, static_cast<double>(depth_count_ - 4)));
  const double t = x - static_cast<double>(first) - 1;
  const std::array<double, 4> weight{-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                                     -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  const std::array<double, 4> slope{(-3 * t * t + 6 * t - 2) / 6, (3 * t * t - 4 * t - 1) / 2,
                                    (-3 * t * t + 2 * t + 2) / 2, (3 * t * t - 1) / 6};
  Value v{};
  for (size_t k = 0; k < 4; ++k) {
    const Pair &p = node(angle, low, first + k), &q = node(angle, high, first + k);
    const double r = std::lerp(p.r, q.r, across), tr = std::lerp(p.t, q.t, across);
    v.r += weight[k] * r, v.t += weight[k] * tr;
    v.r_slope += slope[k] * r, v.t_slope += slope[k] * tr;
  }
  const double by_depth = depth < kDeepest ? 1 / (step(depth_count_) * (depth + kOffset)) : 0;
  v.r_slope *= by_depth, v.t_slope *= by_depth;
  return v;
}

}  // namespace frond::leaf
