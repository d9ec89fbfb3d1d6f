#include "instruments/errors/separable_filter.h"

#include <algorithm>
#include <cassert>

namespace frond {
namespace {

/// Correlates `count` lines of `length` values, `step` apart within a line and `line_step` from line to line.
std::vector<float> filter_lines(const std::vector<float>& in, int count, int length, size_t line_step, size_t step,
                                std::span<const double> kernel) {
  const int radius = static_cast<int>(kernel.size() / 2);
  std::vector<float> out(in.size());
  for (int line = 0; line < count; ++line) {
    const size_t start = static_cast<size_t>(line) * line_step;
    for (int i = 0; i < length; ++i) {
      double sum = 0;
      for (int k = -radius; k <= radius; ++k) {
        const auto at = static_cast<size_t>(std::clamp(i + k, 0, length - 1));
        sum += kernel[static_cast<size_t>(k + radius)] * static_cast<double>(in[start + at * step]);
      }
      out[start + static_cast<size_t>(i) * step] = static_cast<float>(sum);
    }
  }
  return out;
}

}  // namespace

Image separable_filter(const Image& image, std::span<const double> along_x, std::span<const double> along_y) {
  assert(image.channels.size() == 1);
  const auto width = static_cast<size_t>(image.width);
  const auto rows = filter_lines(image.pixels, image.height, image.width, width, 1, along_x);
  Image result(image.width, image.height, image.channels);
  result.pixels = filter_lines(rows, image.width, image.height, 1, width, along_y);
  return result;
}

}  // namespace frond
