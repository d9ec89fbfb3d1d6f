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

/// Whether a channel is a bucket of pbrt-v4 or of bucket_bands, by the three digits of its wavelength: its unit is the
/// radiance of a white surface in equal-energy light of luminance 1.
bool is_bucket(std::string_view channel) {
  constexpr size_t kDigits = 3;
  return channel.ends_with(kUnit) && channel.rfind(',') + 1 + kDigits + kUnit.size() == channel.size();
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Channel of radiance: its wavelength or the name of its band, and its index in the image.
struct SpectralChannel {
  std::optional<double> nm;
  std::string name;
  size_t index;
};
/// Returns an image's channels of radiance: wavelengths, ascending, before names.
std::vector<SpectralChannel> spectral_channels(const Image& image) {
  std::vector<SpectralChannel> channels;
  for (size_t i = 0; i < image.channels.size(); ++i) {
    const std::string& name = image.channels[i];
    if (const auto nm = wavelength_of_channel(name))
      channels.push_back({nm, fmt::format("{:g}", *nm), i});
    else if (name.starts_with(kPrefix) && name.size() > kPrefix.size())
      channels.push_back({{}, name.substr(kPrefix.size()), i});
  }
  std::ranges::stable_sort(channels, {}, [](const SpectralChannel& c) { return c.nm.value_or(INFINITY); });
  return channels;
}

std::vector<std::string> names_of(const std::vector<SpectralChannel>& channels) {
  std::vector<std::string> names;
  for (const SpectralChannel& c : channels) names.push_back(c.name);
  return names;
}

size_t channel_of(const std::string& band, const std::vector<SpectralChannel>& channels, const std::string& path) {
  constexpr double kFarthest_nm = 10;
  const auto named = std::ranges::find(channels, band, &SpectralChannel::name);
  if (named != channels.end()) return named->index;
  const auto nm = number_of(band);
  if (!nm) fail({}, "{} has no band \"{}\"; its bands are {}", path, band, fmt::join(names_of(channels), ", "));
  const auto distance = [nm](const SpectralChannel& c) { return std::abs(c.nm.value_or(INFINITY) - *nm); };
  const auto nearest = std::ranges::min_element(channels, {}, distance);
  if (distance(*nearest) <= kFarthest_nm) return nearest->index;
  fail({}, "{} has no band within {} nm of {} nm; its bands are at {}{}", path, kFarthest_nm, band,
       fmt::join(names_of(channels), ", "), channels.front().nm ? " nm" : "");
}

}  // namespace

/// In float and with three digits, as in pbrt-v4: the names are the same to the last digit.
std::vector<Band> bucket_bands(int count, Interval range_nm) {
  const auto min = float(range_nm.min), max = float(range_nm.max);
  std::vector<Band> bands;
  for (int i = 0; i < count; ++i) {
    const float t = (float(i) + 0.5f) / float(count), center = (1 - t) * min + t * max;
    std::string name = fmt::format("{:.3f}{}", center, kUnit);
    std::ranges::replace(name, '.', ',');
    bands.push_back({double(center), {}, name});
  }
  return bands;
}

std::string spectral_channel(double nm) { return std::string(kPrefix) + wavelength_text(nm); }

std::string spectral_channel(const Band& band) {
  return band.name.empty() ? spectral_channel(band.nm) : std::string(kPrefix) + band.name;
}

std::string variance_channel(const Band& band) {
  return "variance." + (band.name.empty() ? wavelength_text(band.nm) : band.name);
}

std::optional<double> wavelength_of_channel(const std::string& name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kUnit)) return {};
  std::string number = name.substr(kPrefix.size(), name.size() - kPrefix.size() - kUnit.size());
  std::ranges::replace(number, ',', '.');
  return number_of(number);
}

std::vector<std::string> bands_of(const Image& image) { return names_of(spectral_channels(image)); }

std::string preview_space(std::span<const Band> bands) {
  return xyz_of_bands(bands).empty() ? std::string() : std::string(find_color_space("srgb")->linear_name);
}

std::map<std::string, std::string> spectral_attributes(std::span<const Band> bands) {
  std::map<std::string, std::string> text{{"spectralLayoutVersion", "1.0"}, {"emissiveUnits", "W.m^-2.sr^-1"}};
  for (const Band& band : bands)
    if (!band.response.empty()) text[spectral_channel(band)] = sensitivity_text(band.response);
  return text;
}

Image false_color_image(const ImageFile& file, const std::string& path, std::span<const std::string> bands) {
  const auto channels = spectral_channels(file.image);
  if (channels.empty()) fail({}, "{} has no bands: frond render --wavelengths bands makes images that do", path);
  std::array<size_t, 3> chosen{};
  for (size_t c = 0; c < 3; ++c) chosen[c] = channel_of(bands[c], channels, path);
  Image image = file.image.selected(chosen, {"R", "G", "B"});
  if (is_bucket(file.image.channels[chosen[0]])) return image;
  const auto per_radiance = float(photometric(ConstantSpectrum(1)));
  for (float& v : image.pixels) v *= per_radiance;
  return image;
}

}  // namespace frond
