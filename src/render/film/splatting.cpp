#include "render/film/splatting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace frond {
namespace {

/// Number of positions in the midpoint rule of integrals over a pixel.
constexpr int kSteps = 1024;

/// Mean of value(u) over positions u in a pixel, by the midpoint rule.
template <class F>
double mean_over_pixel(const F& value) {
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += value((i + 0.5) / kSteps);
  return sum / kSteps;
}

bool can_splat(const Filter& filter) {
  const Vec2 radius = filter.radius();
  constexpr float kWidest = float(kMostReach) + 0.5f;
  return radius.x > 0 && radius.y > 0 && radius.x <= kWidest && radius.y <= kWidest && !filter.stays_in_pixel();
}

/// Variance of a pixel with importance sampling of the filter, relative to a box filter of one pixel, along an axis:
/// (integral of |f| / integral of f)^2.
double noise_of_importance(double radius, const auto& value) {
  double sum = 0, magnitude = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double f = value((2 * (i + 0.5) / kSteps - 1) * radius);
    sum += f, magnitude += std::abs(f);
  }
  return std::pow(magnitude / sum, 2);
}

}  // namespace

Crop widened(const Crop& pixels, int x, int y) { return {pixels.x0 - x, pixels.y0 - y, pixels.x1 + x, pixels.y1 + y}; }

Crop intersection(const Crop& a, const Crop& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Crop Splatting::reaching(const Crop& pixels) const {
  return intersection(widened(pixels, reach_x(), reach_y()), sampled);
}

template <class F>
SplatKernel::Axis::Axis(float radius, const F& value)
    : reach(std::max(int(std::ceil(radius - 0.5f)), 0)), width(2 * reach + 1) {
  for (int node = 0; node <= kNodes; ++node)
    for (int pixel = -reach; pixel <= reach; ++pixel)
      table.push_back(value(float(node) / kNodes - 0.5f - float(pixel)));
  float largest = 0;
  for (const float w : table) largest = std::max(largest, std::abs(w));
  const SplatAxis unscaled = described();
  const double sum = std::accumulate(unscaled.mean.begin(), unscaled.mean.end(), 0.0);
  for (float& w : table) w /= std::max(largest, float(sum));
}

double SplatKernel::Axis::weight(double u, int pixel) const {
  const double place = u * kNodes;
  const int node = std::min(int(place), kNodes - 1);
  const auto at = [&](int n) { return double(table[size_t(n * width + pixel + reach)]); };
  return std::lerp(at(node), at(node + 1), place - node);
}

SplatAxis SplatKernel::Axis::described() const {
  SplatAxis axis{.reach = reach};
  for (int pixel = -reach; pixel <= reach; ++pixel) {
    axis.mean.push_back(mean_over_pixel([&](double u) { return weight(u, pixel); }));
    axis.square.push_back(mean_over_pixel([&](double u) { return std::pow(weight(u, pixel), 2); }));
  }
  return axis;
}

double SplatKernel::Axis::correlated_pixels() const {
  const auto products = [this](int lag) {
    double sum = 0;
    for (int pixel = -reach; pixel + lag <= reach; ++pixel)
      sum += mean_over_pixel([&](double u) { return weight(u, pixel) * weight(u, pixel + lag); });
    return sum;
  };
  double sum = 1;
  for (int lag = 1; lag <= 2 * reach; ++lag) sum += 2 * std::abs(products(lag) / products(0));
  return sum;
}

bool SplatKernel::Axis::has_negative_weights() const {
  return std::ranges::any_of(table, [](float w) { return w < 0; });
}

double SplatKernel::Axis::noise() const {
  const SplatAxis axis = described();
  return std::accumulate(axis.square.begin(), axis.square.end(), 0.0) /
         std::pow(std::accumulate(axis.mean.begin(), axis.mean.end(), 0.0), 2);
}

SplatKernel::SplatKernel(const Filter& filter)
    : axes_{Axis(filter.radius().x,
                 [&](float x) {
                   return filter.evaluate_axes({x, 0}).x;
                 }),
            Axis(filter.radius().y, [&](float y) {
              return filter.evaluate_axes({0, y}).y;
            })} {}

Splatting SplatKernel::splatting() const {
  return {.axes = {axes_[0].described(), axes_[1].described()},
          .has_negative_weights = axes_[0].has_negative_weights() || axes_[1].has_negative_weights(),
          .correlated_pixels = axes_[0].correlated_pixels() * axes_[1].correlated_pixels()};
}

SplatValue::SplatValue(const Double4& values) : exponent(kLeastExponent) {
  const double largest = std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2]), std::abs(values[3])});
  double bound = std::ldexp(1.0, kLeastExponent);
  for (; largest >= bound; exponent += kStep) bound *= 1 << kStep;
  const double scale = double(1 << kBits) / bound;
  constexpr double kRounds = 0x1.8p52;
  multiples = values * scale + kRounds - kRounds;
  is_black = multiples[0] == 0 && multiples[1] == 0 && multiples[2] == 0;
}

void SplatSums::restart(int exponent) {
  exponent_ = exponent;
  std::fill_n(sums_.begin(), kernel_->width() * kernel_->height(), Double4{});
}

void SplatSums::add(Vec2 u, const SplatValue& value) {
  const SplatKernel::Weights weights = kernel_->at(u);
  const Double4 colors_and_one{value.multiples[0], value.multiples[1], value.multiples[2], 1};
  Double4* sum = sums_.data();
  for (size_t row = 0; row < size_t(kernel_->height()); ++row)
    for (size_t column = 0; column < size_t(kernel_->width()); ++column, ++sum)
      *sum += colors_and_one * double(weights.at(column, row));
}

bool splats(const Filter& filter) {
  if (!can_splat(filter) || filter.reconstruction() == Reconstruction::importance) return false;
  if (filter.reconstruction() == Reconstruction::splatting) return true;
  const SplatKernel kernel(filter);
  const double splatted = kernel.axes_[0].noise() * kernel.axes_[1].noise(),
               importance = noise_of_importance(double(filter.radius().x),
                                                [&](double x) {
                                                  return double(filter.evaluate_axes({float(x), 0}).x);
                                                }) *
                            noise_of_importance(double(filter.radius().y), [&](double y) {
                              return double(filter.evaluate_axes({0, float(y)}).y);
                            });
  return splatted < importance;
}

}  // namespace frond
