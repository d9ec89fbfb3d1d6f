#include "image/spectral_layout.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/wavelengths/band_preview.h"

namespace frond {
namespace {

constexpr std::string_view kPrefix = "S0.", kUnit = "nm";

/// Returns a wavelength as the layout writes it, such as "551,000000nm".
std::string wavelength_text(double nm) {
  std::string text = fmt::format("{:.6f}", nm);
  std::ranges::replace(text, '.', ',');
  return text.append(kUnit);
}

/// Returns a response as the layout writes spectra, point by point: "450nm:0.5;451nm:0.75;".
std::string sensitivity_text(std::span<const ResponsePoint> response) {
  std::string text;
  for (const auto& [nm, value] : response) text += fmt::format("{}nm:{};", nm, value);
  return text;
}

/// Channel of radiance: its wavelength and its index in the image.
struct SpectralChannel {
  double nm;
  size_t index;
};
/// Returns an image's channels of radiance in ascending order of wavelength.
std::vector<SpectralChannel> spectral_channels(const Image& image) {
  std::vector<SpectralChannel> channels;
  for (size_t i = 0; i < image.channels.size(); ++i)
    if (const auto nm = wavelength_of_channel(image.channels[i])) channels.push_back({*nm, i});
  std::ranges::sort(channels, {}, &SpectralChannel::nm);
  return channels;
}

std::vector<double> wavelengths_of(const std::vector<SpectralChannel>& channels) {
  std::vector<double> nm;
  for (const SpectralChannel& c : channels) nm.push_back(c.nm);
  return nm;
}

size_t nearest_channel(const std::vector<SpectralChannel>& channels, double nm, const std::string& path) {
  constexpr double kFarthest_nm = 10;
  const auto distance = [nm](const SpectralChannel& c) { return std::abs(c.nm - nm); };
  const auto nearest = std::ranges::min_element(channels, {}, distance);
  if (distance(*nearest) <= kFarthest_nm) return nearest->index;
  fail({}, "{} has no band within {} nm of {} nm; its bands are at {} nm", path, kFarthest_nm, nm,
       fmt::join(wavelengths_of(channels), ", "));
}

}  // namespace

std::string spectral_channel(double nm) { return std::string(kPrefix) + wavelength_text(nm); }

std::string variance_channel(double nm) { return "variance." + wavelength_text(nm); }

std::optional<double> wavelength_of_channel(const std::string& name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kUnit)) return {};
  std::string number = name.substr(kPrefix.size(), name.size() - kPrefix.size() - kUnit.size());
  std::ranges::replace(number, ',', '.');
  double nm = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), nm);
  if (error != std::errc() || end != number.data() + number.size()) return {};
  return nm;
}

std::vector<double> bands_of(const Image& image) { return wavelengths_of(spectral_channels(image)); }

std::string preview_space(std::span<const Band> bands) {
  return xyz_of_bands(bands).empty() ? std::string() : std::string(find_color_space("srgb")->linear_name);
}

std::map<std::string, std::string> spectral_attributes(std::span<const Band> bands) {
  std::map<std::string, std::string> text{{"spectralLayoutVersion", "1.0"}, {"emissiveUnits", "W.m^-2.sr^-1"}};
  for (const Band& band : bands)
    if (!band.response.empty()) text[spectral_channel(band.nm)] = sensitivity_text(band.response);
  return text;
}

Image false_color_image(const ImageFile& file, const std::string& path, std::span<const double> nm) {
  const auto channels = spectral_channels(file.image);
  if (channels.empty()) fail({}, "{} has no bands: frond render --wavelengths bands makes images that do", path);
  const auto per_radiance = float(photometric(ConstantSpectrum(1)));
  std::array<size_t, 3> nearest{};
  for (size_t c = 0; c < 3; ++c) nearest[c] = nearest_channel(channels, nm[c], path);
  Image image = file.image.selected(nearest, {"R", "G", "B"});
  for (float& v : image.pixels) v *= per_radiance;
  return image;
}

}  // namespace frond
