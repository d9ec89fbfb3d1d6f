#include "lights/light_image.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "core/stop.h"
#include "image/rgb_file.h"
#include "spectra/cie.h"

namespace frond {
namespace {

using Rgb = std::array<float, 3>;

/// Returns the colour of a texel of an image with three channels.
Rgb rgb_at(const Image& image, size_t texel) {
  return {image.pixels[3 * texel], image.pixels[3 * texel + 1], image.pixels[3 * texel + 2]};
}

/// Table of smooth reflectances for colours with a brightest channel of 1/2, interpolated between fits on a grid,
/// because a fit takes 25 us and photographs have millions of colours. The error is at most 1e-3 of the brightest
/// channel, and mostly much less.
class FitTable {
 public:
  explicit FitTable(const ColorSpace& space) : space_(space), nodes_(3 * kNodes * kNodes) {}

  /// Interpolates the polynomials' coefficients bilinearly. `c` has any scale.
  SigmoidPolynomial at(const Rgb& c) {
    const size_t largest = size_t(std::max_element(c.begin(), c.end()) - c.begin());
    const Place x(c[(largest + 1) % 3] / c[largest]), y(c[(largest + 2) % 3] / c[largest]);
    Triple sum{};
    for (size_t j = 0; j < 2; ++j)
      for (size_t i = 0; i < 2; ++i) {
        const Triple& node = fitted(largest, x.node + i, y.node + j);
        const double weight = (i == 1 ? x.fraction : 1 - x.fraction) * (j == 1 ? y.fraction : 1 - y.fraction);
        for (size_t k = 0; k < 3; ++k) sum[k] += weight * node[k];
      }
    return SigmoidPolynomial(sum);
  }

 private:
  static constexpr size_t kNodes = 65;
  /// Position on a grid that is finer toward saturated colours.
  struct Place {
    explicit Place(float share) {
      const double x = std::sqrt(double(share)) * (kNodes - 1);
      node = std::min(size_t(x), kNodes - 2), fraction = x - double(node);
    }
    size_t node;
    double fraction;
  };

  /// Fits a node on first use: an image needs few of the nodes.
  const Triple& fitted(size_t largest, size_t i, size_t j) {
    std::optional<Triple>& node = nodes_[(largest * kNodes + j) * kNodes + i];
    if (!node) {
      const auto share = [](size_t at) { return double(at * at) / double((kNodes - 1) * (kNodes - 1)); };
      Triple rgb{};
      rgb[largest] = 0.5, rgb[(largest + 1) % 3] = share(i) / 2, rgb[(largest + 2) % 3] = share(j) / 2;
      node = fit_reflectance(space_, rgb).reflectance.coefficients();
    }
    return *node;
  }

  const ColorSpace& space_;
  std::vector<std::optional<Triple>> nodes_;  ///< index: [brightest channel][second channel][third channel]
};

/// Numbers the distinct colours of an image, by a hash table of the first texel of each.
class ColorNumbers {
 public:
  /// The table has at least 1.5 slots for each texel, so that probing terminates quickly.
  explicit ColorNumbers(const Image& image) : image_(image) {
    slots_.resize(std::bit_ceil(image.pixels.size() / 3 * 3 / 2 + 1), kFree);
  }

  struct Number {
    uint32_t number;
    bool is_new;
  };
  /// Returns the number of the texel's colour, by linear probing.
  Number number_of(uint32_t texel) {
    const Rgb c = rgb_at(image_, texel);
    size_t slot = hash(c) & (slots_.size() - 1);
    for (; slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1))
      if (rgb_at(image_, first_[slots_[slot]]) == c) return {slots_[slot], false};
    slots_[slot] = uint32_t(first_.size());
    first_.push_back(texel);
    return {slots_[slot], true};
  }

 private:
  static constexpr uint32_t kFree = UINT32_MAX;

  /// Hash of the bit patterns.
  static size_t hash(const Rgb& c) {
    uint64_t h = 0;
    // 0 and -0 compare equal and must have the same hash.
    for (const float v : c) h = (h ^ std::bit_cast<uint32_t>(v + 0.f)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
    return size_t(h);
  }

  const Image& image_;
  std::vector<uint32_t> slots_;  ///< colour numbers
  std::vector<uint32_t> first_;  ///< by colour number: the first texel
};

}  // namespace

/// 8-bit files are decoded from sRGB; others are linear.
ColorImage read_light_image(const Params& p) {
  ImageFile file = read_rgb(p, "filename");
  if (file.is_encoded) decode_srgb(file.image);
  float lowest = 0;
  for (float& v : file.image.pixels) lowest = std::min(lowest, v), v = std::max(v, 0.f);
  if (lowest < 0)
    p.warn("filename", fmt::format("the image holds values down to {}: negative values are set to 0", lowest));
  const ColorSpace* space = color_space_of(file);
  if (!space) p.warn("filename", "the image's colour space is unknown: sRGB is used");
  return {std::move(file.image), space ? space : find_color_space("srgb")};
}

/// Negative luminances, which wide-gamut colours may have, are set to 0.
std::vector<float> luminances_of(const ColorImage& file) {
  const Triple& y = file.space->xyz_from_rgb.row[1];
  std::vector<float> result;
  for (size_t i = 0; i < file.image.pixels.size() / 3; ++i) {
    const Rgb c = rgb_at(file.image, i);
    result.push_back(std::max(0.f, float(y[0]) * c[0] + float(y[1]) * c[1] + float(y[2]) * c[2]));
  }
  return result;
}

LightImage::LightImage(const ColorImage& file)
    : width_(file.image.width), height_(file.image.height), luminances_(luminances_of(file)), white_(unit_d65()) {
  texels_.reserve(luminances_.size());
  constexpr size_t kMostFits = 10000;
  FitTable table(*file.space);
  ColorNumbers numbers(file.image);
  StopPoll poll;
  for (uint32_t i = 0; i < luminances_.size(); ++i) {
    poll();
    const Rgb c = rgb_at(file.image, i);
    const auto [number, is_new] = numbers.number_of(i);
    texels_.push_back(number);
    if (!is_new) continue;
    // Scaling by twice the brightest channel keeps the reflectance away from 0 and 1.
    const double peak = 2 * double(std::max({c[0], c[1], c[2]}));
    if (peak == 0) {
      colors_.push_back({SigmoidPolynomial({0, 0, 0}), 0});
      continue;
    }
    const Triple share{double(c[0]) / peak, double(c[1]) / peak, double(c[2]) / peak};
    check_stop();
    const SigmoidPolynomial reflectance =
        colors_.size() < kMostFits ? fit_reflectance(*file.space, share).reflectance : table.at(c);
    colors_.push_back({reflectance, float(peak)});
  }
}

double LightImage::mean_luminance() const {
  double sum = 0;
  for (const float v : luminances_) sum += double(v);
  return sum / double(luminances_.size());
}

/// Returns the index of a texel, clamped to the image.
size_t LightImage::texel(int x, int y) const {
  return size_t(std::clamp(y, 0, height_ - 1)) * size_t(width_) + size_t(std::clamp(x, 0, width_ - 1));
}

SampledSpectrum LightImage::texel_spectrum(size_t texel, const SampledWavelengths& lambda) const {
  const Color& c = colors_[texels_[texel]];
  SampledSpectrum s;
  for (int i = 0; i < lambda.count; ++i) s[i] = c.scale * c.reflectance.at(lambda.nm[size_t(i)]);
  return s;
}

/// (u, v) is clamped to the unit square.
SampledSpectrum LightImage::nearest(Vec2 uv, const SampledWavelengths& lambda) const {
  const auto cell = [](float t, int size) { return int(std::clamp(t, 0.f, 1.f) * float(size)); };
  return white_->sample(lambda) * texel_spectrum(texel(cell(uv.x, width_), cell(uv.y, height_)), lambda);
}

/// Texel centres are at half-integer positions.
SampledSpectrum LightImage::bilinear(Vec2 uv, const SampledWavelengths& lambda) const {
  const float x = std::clamp(uv.x, 0.f, 1.f) * float(width_) - 0.5f;
  const float y = std::clamp(uv.y, 0.f, 1.f) * float(height_) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const int i = int(x0), j = int(y0);
  return white_->sample(lambda) * (texel_spectrum(texel(i, j), lambda) * ((1 - fx) * (1 - fy)) +
                                   texel_spectrum(texel(i + 1, j), lambda) * (fx * (1 - fy)) +
                                   texel_spectrum(texel(i, j + 1), lambda) * ((1 - fx) * fy) +
                                   texel_spectrum(texel(i + 1, j + 1), lambda) * (fx * fy));
}

}  // namespace frond
