#include "core/math/distribution.h"

#include <algorithm>

namespace frond {

/// The last entry is set to 1 exactly, so that every u < 1 finds a cell.
Distribution1D::Distribution1D(const std::vector<float>& weights) : cdf_(weights.size() + 1, 0.0) {
  for (size_t i = 0; i < weights.size(); ++i) cdf_[i + 1] = cdf_[i] + static_cast<double>(weights[i]);
  sum_ = cdf_.back();
  const double n = static_cast<double>(weights.size());
  for (size_t i = 1; i < cdf_.size(); ++i) cdf_[i] = sum_ > 0 ? cdf_[i] / sum_ : static_cast<double>(i) / n;
  cdf_.back() = 1;
  for (size_t i = 0, cell = 0; i < weights.size(); ++i) {
    while (cdf_[cell + 1] <= static_cast<double>(i) / n) ++cell;
    guide_.push_back(static_cast<uint32_t>(cell));
  }
}

/// The fraction is kept below 1 after rounding.
Distribution1D::Sample Distribution1D::sample(float u) const {
  const double x = static_cast<double>(u);
  size_t cell = guide_[static_cast<size_t>(x * static_cast<double>(guide_.size()))];
  while (cdf_[cell + 1] <= x) ++cell;
  const double width = cdf_[cell + 1] - cdf_[cell];
  const float fraction = width > 0 ? static_cast<float>((x - cdf_[cell]) / width) : 0;
  return {cell, std::min(fraction, 0x1.fffffep-1f), static_cast<float>(width)};
}

namespace {

/// Returns the conditional distributions of the rows.
std::vector<Distribution1D> make_rows(const std::vector<float>& weights, int width) {
  std::vector<Distribution1D> rows;
  for (auto row = weights.begin(); row != weights.end(); row += width)
    rows.emplace_back(std::vector<float>(row, row + width));
  return rows;
}

/// Returns the weights of the marginal distribution.
std::vector<float> row_sums(const std::vector<Distribution1D>& rows) {
  std::vector<float> sums;
  for (const Distribution1D& row : rows) sums.push_back(static_cast<float>(row.sum()));
  return sums;
}

/// Returns the cell of a coordinate, clamped to the valid range.
size_t cell_of(float x, size_t cells) {
  return std::min(cells - 1, static_cast<size_t>(std::max(0.f, x * static_cast<float>(cells))));
}

}  // namespace

Distribution2D::Distribution2D(const std::vector<float>& weights, int width)
    : rows_(make_rows(weights, width)), marginal_(row_sums(rows_)) {}

/// Samples the row by the marginal, then the cell within the row.
Distribution2D::Sample Distribution2D::sample(Vec2 u) const {
  const auto [y, fy, py] = marginal_.sample(u.y);
  const auto [x, fx, px] = rows_[y].sample(u.x);
  const float width = static_cast<float>(rows_[y].size()), height = static_cast<float>(rows_.size());
  return {{(static_cast<float>(x) + fx) / width, (static_cast<float>(y) + fy) / height}, px * py * width * height};
}

float Distribution2D::pdf(Vec2 uv) const {
  const size_t y = cell_of(uv.y, rows_.size()), x = cell_of(uv.x, rows_[y].size());
  return marginal_.probability(y) * rows_[y].probability(x) * static_cast<float>(rows_.size() * rows_[y].size());
}

WindowedDistribution::WindowedDistribution(const std::vector<float>& weights, int width)
    : width_(width), height_(int(weights.size()) / width) {
  const size_t row = size_t(width_) + 1;
  sums_.assign(row * (size_t(height_) + 1), 0);
  for (size_t y = 0; y < size_t(height_); ++y) {
    double left = 0;
    for (size_t x = 0; x < size_t(width_); ++x) {
      left += double(weights[y * size_t(width_) + x]);
      sums_[(y + 1) * row + x + 1] = sums_[y * row + x + 1] + left;
    }
  }
}

/// Returns the window in units of cells, clamped to the square.
WindowedDistribution::Box WindowedDistribution::box(const Window& w) const {
  const auto at = [](float t, int cells) { return std::clamp(double(t), 0.0, 1.0) * cells; };
  return {at(w.min.x, width_), at(w.max.x, width_), at(w.min.y, height_), at(w.max.y, height_)};
}

/// Interpolates the summed-area table bilinearly: exact for a piecewise constant density.
double WindowedDistribution::cumulative(double x, double y) const {
  const int i = std::min(int(x), width_ - 1), j = std::min(int(y), height_ - 1);
  const double fx = x - i, fy = y - j;
  const double* const low = &sums_[size_t(j) * (size_t(width_) + 1) + size_t(i)];
  const double* const high = low + width_ + 1;
  return std::lerp(std::lerp(low[0], low[1], fx), std::lerp(high[0], high[1], fx), fy);
}

/// Returns the integral over a box.
double WindowedDistribution::sum(const Box& b) const {
  return cumulative(b.x1, b.y1) - cumulative(b.x0, b.y1) - cumulative(b.x1, b.y0) + cumulative(b.x0, b.y0);
}

namespace {

/// A position and the cell that contains it.
struct Place {
  double at;
  int cell;
};

/// Returns the position in [first, last] at which a sum, piecewise linear between integers, reaches the share u of its
/// last value.
template <class Sum>
Place find_interval(double first, double last, double u, const Sum& sum) {
  const double target = u * sum(last);
  int low = int(first), high = std::max(low, int(std::ceil(last)) - 1);
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (sum(std::min(middle + 1.0, last)) > target)
      high = middle;
    else
      low = middle + 1;
  }
  const double a = std::max(double(low), first), b = std::min(low + 1.0, last);
  const double from = sum(a), step = sum(b) - from;
  return {step > 0 ? std::clamp(a + (target - from) / step * (b - a), a, b) : a, low};
}

}  // namespace

/// Samples x by the window's column sums, then y within that column of cells.
std::optional<WindowedDistribution::Sample> WindowedDistribution::sample(Vec2 u, const Window& window) const {
  const Box b = box(window);
  const double total = sum(b);
  if (!(total > 0)) return {};
  const auto [x, i] = find_interval(b.x0, b.x1, double(u.x), [&](double to) { return sum({b.x0, to, b.y0, b.y1}); });
  const double left = std::max(double(i), b.x0), right = std::min(i + 1.0, b.x1);
  const auto [y, j] = find_interval(b.y0, b.y1, double(u.y), [&](double to) { return sum({left, right, b.y0, to}); });
  const double density = weight(i, j) / total * width_ * height_;
  if (!(density > 0)) return {};
  return Sample{{float(x / width_), float(y / height_)}, float(density)};
}

float WindowedDistribution::pdf(Vec2 uv, const Window& window) const {
  const double total = sum(box(window));
  if (!(total > 0) || !window.contains(uv)) return 0;
  const auto cell = [](float t, int cells) { return std::clamp(int(t * float(cells)), 0, cells - 1); };
  return float(weight(cell(uv.x, width_), cell(uv.y, height_)) / total * width_ * height_);
}

}  // namespace frond
