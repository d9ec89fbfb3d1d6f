#include "image/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "spectra/color/color_space.h"

namespace frond {
namespace {

constexpr double kMostStops = 64;

/// Weights of the channels in the luminance; sRGB's weights for a space that frond does not know, such as one of an
/// OpenColorIO configuration.
Triple luminance_weights(std::string_view space) {
  if (space == kXyzName) return {0, 1, 0};
  const ColorSpace* known = find_color_space(space);
  const Matrix3& m = (known ? *known : color_spaces().front()).xyz_from_rgb;
  return m.row[1];
}

}  // namespace

std::optional<ExposureChoice> parse_exposure(std::string_view text) {
  if (text == "auto") return ExposureChoice{0, true};
  if (text.starts_with('+')) text.remove_prefix(1);
  double stops = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), stops);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(stops) <= kMostStops)) return {};
  return ExposureChoice{stops, false};
}

/// Steps of a third, in two digits: images with other noise get the same exposure as a rule, and a number of the header
/// repeats it.
ExposureMeter measure_exposure(const Image& image, std::string_view space) {
  constexpr double kMidGrey = 0.18, kDark = 0.002, kMayClip = 0.02, kSteps = 3;
  const Triple weights = luminance_weights(space);
  const size_t channels = image.channels.size();
  std::vector<double> lit;
  double logs = 0;
  ExposureMeter meter;
  const size_t pixels = size_t(image.width) * size_t(image.height);
  for (size_t i = 0; i < pixels; ++i) {
    double y = 0;
    for (size_t c = 0; c < 3; ++c) y += weights[c] * double(image.pixels[i * channels + c]);
    meter.clipped += y > 1;
    if (!(y > 0) || !std::isfinite(y)) continue;
    lit.push_back(y);
    logs += std::log2(y);
    meter.dark += y < kDark;
  }
  if (pixels > 0) meter.clipped /= double(pixels);
  if (lit.empty()) return meter;
  meter.dark /= double(lit.size());
  const double mean = logs / double(lit.size());
  const auto bright = lit.begin() + ptrdiff_t(double(lit.size() - 1) * (1 - kMayClip));
  std::ranges::nth_element(lit, bright);
  const double wanted = std::min(std::log2(kMidGrey) - mean, -std::log2(*bright));
  const double third = std::round(wanted * kSteps) / kSteps;
  meter.stops = std::clamp(std::round(third * 100) / 100, -kMostStops, kMostStops);
  return meter;
}

void expose(Image& image, double stops) {
  if (stops == 0) return;
  const auto factor = float(std::exp2(stops));
  for (float& v : image.pixels) v *= factor;
}

std::string exposure_advice(const ExposureMeter& meter, const std::string& option) {
  constexpr double kNearlyAll = 0.95, kMost = 0.5;
  const auto advice = [&](const std::string& what) {
    return fmt::format("{}: {} auto would change the exposure by {} stops", what, option, stops_text(meter.stops));
  };
  if (meter.dark > kNearlyAll) return advice("nearly all of the image is too dark to be seen");
  if (meter.clipped > kMost)
    return advice(fmt::format("{:.0f} % of the image is brighter than white", 100 * meter.clipped));
  return {};
}

std::string stops_text(double stops) {
  const double rounded = std::round(stops * 100) / 100;
  return rounded == 0 ? "0" : fmt::format("{:+}", rounded);
}

}  // namespace frond
