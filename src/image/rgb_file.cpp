#include "image/rgb_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/messages/excerpt.h"
#include "image/spectral_layout.h"

namespace frond {
namespace {

constexpr std::array<const char*, 3> kRgb{"R", "G", "B"};

/// Names of channels for a message, of which there may be thousands.
std::string names_of(const std::vector<std::string>& channels, const std::filesystem::path& path) {
  constexpr size_t kMost = 8;
  std::vector<std::string> shown;
  for (size_t i = 0; i < std::min(kMost, channels.size()); ++i) shown.push_back(excerpt(channels[i], path));
  const size_t more = channels.size() - shown.size();
  return fmt::format("{}{}", fmt::join(shown, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Channels that are neither read as a colour or a number nor the variance of a render.
std::vector<std::string> unused_channels(const Image& image) {
  std::vector<std::string> unused;
  for (const std::string& name : image.channels)
    if (name.size() != 1 || std::string_view("RGBAY").find(name) == std::string_view::npos)
      if (!name.starts_with("variance.")) unused.push_back(name);
  return unused;
}

void warn_of_unused_channels(const Params& p, std::string_view name, const ImageFile& file) {
  for (const std::string& message : file.left_out) p.warn(name, message);
  if (const auto unused = unused_channels(file.image); !unused.empty())
    p.warn(name, fmt::format("channels of the image that are not used: {}", names_of(unused, p.file(name))));
}

Image rgb_of(const Image& image, const std::filesystem::path& path, const Location& where) {
  std::array<size_t, 3> channels{};
  for (size_t c = 0; c < 3; ++c) {
    const auto channel = image.channel(kRgb[c]);
    if (!channel)
      fail(where, "{} has no channel {}; it has {}", path.string(), kRgb[c], names_of(image.channels, path));
    channels[c] = *channel;
  }
  return image.selected(channels, {kRgb.begin(), kRgb.end()});
}

void check_finite(const Image& image, const std::filesystem::path& path, const Location& where) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < image.channels.size(); ++c)
        if (const float v = image.at(x, y, c); !std::isfinite(v))
          fail(where, "{} holds the value {} in column {}, row {}", path.string(), v, x, y);
}

bool is_same_chromaticity(const Chromaticity& a, const Chromaticity& b) {
  constexpr double kSame = 2e-3;  // tolerance for chromaticities rounded to three decimals
  return std::abs(a.x - b.x) < kSame && std::abs(a.y - b.y) < kSame;
}

/// Throws InputError if the image has bands and no colours.
void check_colors(const std::string& path, const Image& image) {
  const auto bands = bands_of(image);
  if (bands.empty() || image.channel(kRgb[0])) return;
  const bool are_named = std::ranges::none_of(
      image.channels, [](const std::string& name) { return wavelength_of_channel(name).has_value(); });
  fail({},
       "{} holds bands {} and no colours; frond convert --bands {},{},{} shows three of them, and frond compare "
       "--wavelengths bands,... reports errors band by band",
       path,
       are_named ? fmt::format("{}", fmt::join(bands, ", "))
                 : fmt::format("from {} to {} nm", bands.front(), bands.back()),
       bands.back(), bands[bands.size() / 2], bands.front());
}

/// Linear name of the colour space that a file states, by name or by chromaticities; empty if it states none. Throws
/// InputError for unknown chromaticities.
std::string stated_space(const std::string& path, const ImageFile& file) {
  if (!file.header.color_space.empty() || !file.chromaticities) return file.header.color_space;
  if (const ColorSpace* space = color_space_of(file)) return std::string(space->linear_name);
  const Chromaticities& c = *file.chromaticities;
  fail({}, "{} has the chromaticities of no known colour space: red {} {}, green {} {}, blue {} {}, white {} {}", path,
       c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y);
}

}  // namespace

const ColorSpace* color_space_of(const ImageFile& file) {
  if (const ColorSpace* named = find_color_space(file.header.color_space)) return named;
  if (!file.chromaticities) return find_color_space("srgb");
  const Chromaticities& c = *file.chromaticities;
  for (const ColorSpace& space : color_spaces()) {
    const Chromaticities& s = space.chromaticities;
    if (is_same_chromaticity(c.red, s.red) && is_same_chromaticity(c.green, s.green) &&
        is_same_chromaticity(c.blue, s.blue) && is_same_chromaticity(c.white, s.white))
      return &space;
  }
  return nullptr;
}

ImageFile read_finite(const std::filesystem::path& path, const Location& where) {
  ImageFile file = read_image(path, where);
  check_finite(file.image, path, where);
  return file;
}

namespace {

/// Reduces a file to R, G and B.
ImageFile keep_rgb_channels(ImageFile file, const std::filesystem::path& path, const Location& where) {
  if (file.image.channels.size() > 2)
    file.image = rgb_of(file.image, path, where);
  else
    file.image = file.image.selected(std::array<size_t, 3>{}, {kRgb.begin(), kRgb.end()});
  check_finite(file.image, path, where);
  return file;
}

}  // namespace

ImageFile read_rgb(const std::filesystem::path& path, const Location& where) {
  return keep_rgb_channels(read_image(path, where), path, where);
}

ImageFile read_rgb(const Params& p, std::string_view name) {
  ImageFile file = read_image(p.file(name), p.where(name));
  warn_of_unused_channels(p, name, file);
  return keep_rgb_channels(std::move(file), p.file(name), p.where(name));
}

ImageFile read_finite(const Params& p, std::string_view name) {
  ImageFile file = read_finite(p.file(name), p.where(name));
  warn_of_unused_channels(p, name, file);
  return file;
}

float decode_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

void decode_srgb(Image& image) {
  for (float& v : image.pixels) v = decode_srgb(v);
}

LinearFile read_linear(const std::string& path, const std::string& otherwise) {
  const ImageFile file = read_image(path, {});
  if (file.is_encoded) fail({}, "{} is encoded for a display: a linear image is needed, such as EXR", path);
  check_colors(path, file.image);
  const std::string stated = stated_space(path, file);
  if (stated.empty() && otherwise.empty())
    fail({},
         "{} does not state its colour space: images that frond has written do; frond convert --color-space writes "
         "an image that does",
         path);
  LinearFile result{.path = path,
                    .space = stated.empty() ? otherwise : stated,
                    .is_assumed = stated.empty(),
                    .image = rgb_of(file.image, path, {}),
                    .leaf = {},
                    .seed = {},
                    .left_out = file.left_out};
  if (const auto leaf = file.image.channel("leaf")) result.leaf = file.image.plane(*leaf);
  if (const auto seed = file.header.text.find("frond:seed"); seed != file.header.text.end()) result.seed = seed->second;
  if (const auto pixels = file.header.text.find("frond:correlated_pixels"); pixels != file.header.text.end())
    if (const double given = std::strtod(pixels->second.c_str(), nullptr); given >= 1 && std::isfinite(given))
      result.correlated_pixels = given;
  return result;
}

void check_same_size(const LinearFile& a, const LinearFile& b) {
  if (a.image.width != b.image.width || a.image.height != b.image.height)
    fail({}, "{} is {} x {}, {} is {} x {}: images of one size are needed", a.path, a.image.width, a.image.height,
         b.path, b.image.width, b.image.height);
}

}  // namespace frond
