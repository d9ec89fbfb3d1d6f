#include "image/white_balance.h"

#include <charconv>

#include "spectra/cie.h"
#include "spectra/daylight.h"

namespace frond {
namespace {

/// Takes a number from the beginning of the text. Returns nullopt if there is none.
std::optional<double> take_number(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return {};
  text.remove_prefix(size_t(end - text.data()));
  return value;
}

}  // namespace

std::optional<WhiteChoice> parse_white(std::string_view text) {
  constexpr double kColdest_kelvin = 1000, kHottest_kelvin = 1e5;
  if (text == "auto") return WhiteChoice{0, true};
  const auto kelvin = take_number(text);
  if (!kelvin || !text.empty() || !(*kelvin >= kColdest_kelvin && *kelvin <= kHottest_kelvin)) return {};
  return WhiteChoice{*kelvin, false};
}

Chromaticity daylight_white(double kelvin) {
  const auto [x, y, z] = to_xyz(*daylight(kelvin));
  return {x / (x + y + z), y / (x + y + z)};
}

std::string chromaticity_text(const Chromaticity& c) { return fmt::format("{:.6g} {:.6g}", c.x, c.y); }

/// Values that no light has are refused: y divides.
std::optional<Chromaticity> parse_chromaticity(std::string_view text) {
  const auto x = take_number(text);
  if (!x || !text.starts_with(' ')) return {};
  text.remove_prefix(1);
  const auto y = take_number(text);
  if (!y || !text.empty() || !(*x > 0 && *x < 1 && *y > 0.01 && *y < 1)) return {};
  return Chromaticity{*x, *y};
}

void balance_white(Image& image, std::string_view space, const Chromaticity& white) {
  Matrix3 map = bradford(white.xyz(), kD65White.xyz());
  if (space != kXyzName) {
    const ColorSpace* known = find_color_space(space);
    if (!known) fail({}, "the white of an image in the colour space \"{}\" cannot be balanced", space);
    map = known->rgb_from_xyz * map * known->xyz_from_rgb;
  }
  const size_t channels = image.channels.size();
  for (size_t i = 0; i + 2 < image.pixels.size(); i += channels) {
    const Triple v = map * Triple{double(image.pixels[i]), double(image.pixels[i + 1]), double(image.pixels[i + 2])};
    for (size_t c = 0; c < 3; ++c) image.pixels[i + c] = float(v[c]);
  }
}

}  // namespace frond
