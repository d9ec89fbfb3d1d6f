#include "study/choose/pilot_pixels.h"

#include <cmath>

#include "core/math/random.h"

namespace frond::choose {
namespace {

std::vector<PixelPosition> all_pixels(const Crop& crop) {
  std::vector<PixelPosition> pixels;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) pixels.push_back({x, y});
  return pixels;
}

}  // namespace

std::vector<PixelPosition> pilot_pixels(const Crop& crop, size_t count, uint64_t seed) {
  const double width = crop.width(), height = crop.height();
  if (width * height <= double(count)) return all_pixels(crop);
  const int columns = std::max(1, int(std::lround(std::sqrt(double(count) * width / height))));
  const int rows = std::max(1, int(double(count) / columns));
  std::vector<PixelPosition> pixels;
  RandomStream random(seed);
  const auto inside = [&random](int cell, int cells, double size) {
    return std::min(int((cell + random.uniform_double()) / cells * size), int(size) - 1);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int x = crop.x0 + inside(column, columns, width);
      pixels.push_back({x, crop.y0 + inside(row, rows, height)});
    }
  return pixels;
}

}  // namespace frond::choose
