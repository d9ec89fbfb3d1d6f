#include "scene/distribution.h"

#include <algorithm>

namespace frond {

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

Distribution1D::Sample Distribution1D::sample(float u) const {
  const double x = static_cast<double>(u);
  size_t cell = guide_[static_cast<size_t>(x * static_cast<double>(guide_.size()))];
  while (cdf_[cell + 1] <= x) ++cell;
  const double width = cdf_[cell + 1] - cdf_[cell];
  const float fraction = width > 0 ? static_cast<float>((x - cdf_[cell]) / width) : 0;
  return {cell, std::min(fraction, 0x1.fffffep-1f), static_cast<float>(width)};
}

namespace {

std::vector<Distribution1D> make_rows(const std::vector<float>& weights, int width) {
  std::vector<Distribution1D> rows;
  for (auto row = weights.begin(); row != weights.end(); row += width)
    rows.emplace_back(std::vector<float>(row, row + width));
  return rows;
}

std::vector<float> row_sums(const std::vector<Distribution1D>& rows) {
  std::vector<float> sums;
  for (const Distribution1D& row : rows) sums.push_back(static_cast<float>(row.sum()));
  return sums;
}

size_t cell_of(float x, size_t cells) {
  return std::min(cells - 1, static_cast<size_t>(std::max(0.f, x * static_cast<float>(cells))));
}

}  // namespace

Distribution2D::Distribution2D(const std::vector<float>& weights, int width)
    : rows_(make_rows(weights, width)), marginal_(row_sums(rows_)) {}

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

}  // namespace frond
