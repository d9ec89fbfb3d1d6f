#include "image/terminal_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace frond {
namespace {

/// Appends the escape code (SGR) of a 24-bit colour; `ground` is 38 for the foreground, 48 for the background.
void append_color(std::string& text, int ground, const float* rgb) {
  const auto byte = [](float v) { return int(std::lround(255 * std::clamp(v, 0.0f, 1.0f))); };
  fmt::format_to(std::back_inserter(text), "\x1b[{};2;{};{};{}m", ground, byte(rgb[0]), byte(rgb[1]), byte(rgb[2]));
}

}  // namespace

Image fitted_image(const Image& image, int columns, int rows) {
  const double scale =
      std::min({1.0, double(columns) / double(image.width), 2.0 * double(rows) / double(image.height)});
  const auto scaled = [scale](int side) { return std::max(1, int(std::lround(side * scale))); };
  Image result(scaled(image.width), scaled(image.height), image.channels);
  for (int y = 0; y < result.height; ++y) {
    const int y0 = int(int64_t(y) * image.height / result.height),
              y1 = int(int64_t(y + 1) * image.height / result.height);
    for (int x = 0; x < result.width; ++x) {
      const int x0 = int(int64_t(x) * image.width / result.width),
                x1 = int(int64_t(x + 1) * image.width / result.width);
      for (size_t c = 0; c < image.channels.size(); ++c) {
        double sum = 0;
        for (int from_y = y0; from_y < y1; ++from_y)
          for (int from_x = x0; from_x < x1; ++from_x) sum += double(image.at(from_x, from_y, c));
        result.at(x, y, c) = float(sum / (double(x1 - x0) * double(y1 - y0)));
      }
    }
  }
  return result;
}

std::string terminal_text(const Image& shown) {
  constexpr int kForeground = 38, kBackground = 48;
  std::string text;
  for (int y = 0; y < shown.height; y += 2) {
    for (int x = 0; x < shown.width; ++x) {
      append_color(text, kForeground, &shown.at(x, y, 0));
      if (y + 1 < shown.height) append_color(text, kBackground, &shown.at(x, y + 1, 0));
      text += "▀";
    }
    text += "\x1b[0m\n";
  }
  return text;
}

}  // namespace frond
