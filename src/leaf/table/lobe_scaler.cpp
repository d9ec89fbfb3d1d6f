#include "leaf/table/lobe_scaler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "leaf/solve/azimuth.h"
#include "leaf/solve/quadrature.h"

namespace frond::leaf {

using std::numbers::pi;

namespace {

/// Number of angles of the quadrature: a lobe of exponent e is about 1 / sqrt(e) wide, and one of exponent 0 is cut off
/// at its full brightness.
int angle_count(double exponent) {
  constexpr double kSmooth = 0.1;
  return exponent < kSmooth ? 200 : 48 + static_cast<int>(3 * std::sqrt(exponent));
}

}  // namespace

LobeScaler::LobeScaler(double exponent, const std::vector<double>& cosines) {
  for (const auto& [x, weight] : gauss_legendre(angle_count(exponent))) {
    const double theta = x * pi / 2, cosine = std::cos(theta);
    directions_.push_back({cosine, weight * pi / 2 * 2 * pi * std::sin(theta) * cosine});
  }
  const AzimuthModes azimuth(exponent);
  const auto lobe = [&](double a, double b) { return (exponent + 1) / (2 * pi) * azimuth.mean(a, b); };
  const size_t count = directions_.size();
  lobes_.resize(count * count);
  for (size_t i = 0; i < count; ++i)
    for (size_t j = 0; j <= i; ++j)
      lobes_[i * count + j] = lobes_[j * count + i] = lobe(directions_[i].cosine, directions_[j].cosine);
  for (const double cosine : cosines)
    for (const Direction& d : directions_) lobes_at_.push_back(lobe(cosine, d.cosine));
  arriving_.assign(count, 1.0);
}

std::vector<double> LobeScaler::operator()(const Reflectance& reflectance) {
  constexpr int kMostSteps = 500;
  constexpr double kDone = 1e-12, kLeast = 1e-150;
  const size_t count = directions_.size();
  std::vector<double> share, out(count), result;
  for (const Direction& d : directions_) share.push_back(reflectance(d.cosine));
  if (std::ranges::max(share) <= 0) return std::vector<double>(lobes_at_.size() / count, 1.0);
  const auto sum_at = [&](const double* lobes) {
    return std::max(std::inner_product(out.begin(), out.end(), lobes, 0.0), kLeast);
  };
  for (int step = 0; step < kMostSteps; ++step) {
    for (size_t i = 0; i < count; ++i) out[i] = directions_[i].weight * share[i] / arriving_[i];
    double off = 0;
    for (size_t i = 0; i < count; ++i) {
      const double sum = sum_at(&lobes_[i * count]);
      if (share[i] > 0) off = std::max(off, std::abs(sum / arriving_[i] - 1));
      arriving_[i] = std::sqrt(sum * arriving_[i]);
    }
    if (off < kDone) break;
  }
  for (size_t k = 0; k < lobes_at_.size(); k += count) result.push_back(sum_at(&lobes_at_[k]));
  return result;
}

}  // namespace frond::leaf
