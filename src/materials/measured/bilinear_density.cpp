#include "materials/measured/bilinear_density.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace frond {
namespace {

float lerp(float a, float b, float t) { return (1 - t) * a + t * b; }

/// Returns t in [0, 1] with (a + (b - a) t / 2) t = area: inversion of a density that is linear from a to b.
float invert_linear(float a, float b, float area) {
  const float root = a + std::sqrt(std::max(0.f, a * a + 2 * area * (b - a)));
  return root > 0 ? std::clamp(2 * area / root, 0.f, 1.f) : 0;
}

/// Largest i in [0, count - 2] with at(i) <= x.
template <class At>
uint32_t find_interval(uint32_t count, float x, const At& at) {
  uint32_t low = 0, high = count - 1;
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    (at(middle) <= x ? low : high) = middle;
  }
  return low;
}

}  // namespace

BilinearStack::BilinearStack(std::vector<float> values, size_t width, size_t height)
    : values_(std::move(values)), width_(static_cast<uint32_t>(width)), height_(static_cast<uint32_t>(height)) {}

BilinearStack::Cell BilinearStack::cell(Vec2 p) const {
  const auto along = [](float x, uint32_t nodes) {
    const float cells = static_cast<float>(nodes - 1), at = std::clamp(x, 0.f, 1.f) * cells;
    const auto whole = std::min(static_cast<uint32_t>(at), nodes - 2);
    return std::pair(whole, at - static_cast<float>(whole));
  };
  const auto [x, tx] = along(p.x, width_);
  const auto [y, ty] = along(p.y, height_);
  return {x, y, {tx, ty}};
}

float BilinearStack::value(size_t slice, const Cell& c) const {
  const float* v = values_.data() + (slice * height_ + c.y) * width_ + c.x;
  return lerp(lerp(v[0], v[1], c.t.x), lerp(v[width_], v[width_ + 1], c.t.x), c.t.y);
}

float BilinearStack::value(const SliceMix& mix, const Cell& cell) const {
  float total = 0;
  for (uint32_t i = 0; i < mix.count; ++i) total += mix.weight[i] * value(mix.slice[i], cell);
  return total;
}

float BilinearStack::sum(const std::vector<float>& array, const SliceMix& mix, uint32_t x, uint32_t y) const {
  float total = 0;
  for (uint32_t i = 0; i < mix.count; ++i)
    total += mix.weight[i] * array[(size_t(mix.slice[i]) * height_ + y) * width_ + x];
  return total;
}

BilinearDensity::BilinearDensity(std::vector<float> values, size_t width, size_t height)
    : BilinearStack(std::move(values), width, height) {
  const size_t size = width * height, slices = values_.size() / size;
  left_.resize(values_.size());
  bottom_.resize(slices * height);
  std::vector<double> row(width), below(height);
  for (size_t s = 0; s < slices; ++s) {
    float* const v = values_.data() + s * size;
    double before = 0;
    for (size_t y = 0; y < height; ++y) {
      double along = 0;
      for (size_t x = 1; x < width; ++x) along += 0.5 * (double(v[y * width + x - 1]) + double(v[y * width + x]));
      below[y] = y == 0 ? 0 : below[y - 1] + 0.5 * (before + along);
      before = along;
    }
    // In units of cells while the cumulative functions are made: their area is 1.
    const double scale = below.back() > 0 ? 1 / below.back() : 0;
    for (size_t y = 0; y < height; ++y) {
      double along = 0;
      for (size_t x = 0; x < width; ++x) {
        if (x > 0) along += 0.5 * (double(v[y * width + x - 1]) + double(v[y * width + x]));
        left_[s * size + y * width + x] = static_cast<float>(along * scale);
      }
      bottom_[s * height + y] = static_cast<float>(below[y] * scale);
    }
    const double per_area = scale * double(width - 1) * double(height - 1);
    for (size_t i = 0; i < size; ++i) v[i] = static_cast<float>(double(v[i]) * per_area);
  }
}

float BilinearDensity::cumulative(const SliceMix& mix, uint32_t y) const {
  float total = 0;
  for (uint32_t i = 0; i < mix.count; ++i) total += mix.weight[i] * bottom_[size_t(mix.slice[i]) * height_ + y];
  return total;
}

BilinearDensity::Mapped BilinearDensity::sample(const SliceMix& mix, Vec2 u) const {
  const float in_y = u.y * cumulative(mix, height_ - 1);
  const uint32_t y = find_interval(height_, in_y, [&](uint32_t i) { return cumulative(mix, i); });
  const float ty =
      invert_linear(sum(left_, mix, width_ - 1, y), sum(left_, mix, width_ - 1, y + 1), in_y - cumulative(mix, y));
  const auto left = [&](uint32_t i) { return lerp(sum(left_, mix, i, y), sum(left_, mix, i, y + 1), ty); };
  const float in_x = u.x * left(width_ - 1);
  const uint32_t x = find_interval(width_, in_x, left);
  const auto value = [&](uint32_t i) { return lerp(sum(values_, mix, i, y), sum(values_, mix, i, y + 1), ty); };
  const float cells = static_cast<float>(width_ - 1) * static_cast<float>(height_ - 1);
  const float a = value(x), b = value(x + 1), tx = invert_linear(a / cells, b / cells, in_x - left(x));
  return {{(static_cast<float>(x) + tx) / static_cast<float>(width_ - 1),
           (static_cast<float>(y) + ty) / static_cast<float>(height_ - 1)},
          lerp(a, b, tx)};
}

BilinearDensity::Mapped BilinearDensity::invert(const SliceMix& mix, Vec2 p) const {
  const Cell c = cell(p);
  const float cells = static_cast<float>(width_ - 1) * static_cast<float>(height_ - 1);
  const auto value = [&](uint32_t i) { return lerp(sum(values_, mix, i, c.y), sum(values_, mix, i, c.y + 1), c.t.y); };
  const auto left = [&](uint32_t i) { return lerp(sum(left_, mix, i, c.y), sum(left_, mix, i, c.y + 1), c.t.y); };
  const float a = value(c.x), b = value(c.x + 1), row = left(width_ - 1), all = cumulative(mix, height_ - 1);
  const float r0 = sum(left_, mix, width_ - 1, c.y), r1 = sum(left_, mix, width_ - 1, c.y + 1);
  const float in_x = left(c.x) + c.t.x * (a + 0.5f * c.t.x * (b - a)) / cells;
  const float in_y = cumulative(mix, c.y) + c.t.y * (r0 + 0.5f * c.t.y * (r1 - r0));
  return {{row > 0 ? in_x / row : 0, all > 0 ? in_y / all : 0}, lerp(a, b, c.t.x)};
}

}  // namespace frond
