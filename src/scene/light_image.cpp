#include "scene/light_image.h"

#include <map>

#include "image/rgb_file.h"
#include "spectra/cie.h"

namespace frond {
namespace {

using Rgb = std::array<float, 3>;

Rgb rgb_at(const Image& image, size_t texel) {
  return {image.pixels[3 * texel], image.pixels[3 * texel + 1], image.pixels[3 * texel + 2]};
}

bool is_near(const Chromaticity& a, const Chromaticity& b) {
  constexpr double kSame = 2e-3;  // of rounded figures
  return std::abs(a.x - b.x) < kSame && std::abs(a.y - b.y) < kSame;
}

const ColorSpace* space_of(const ImageFile& file) {
  if (const ColorSpace* named = find_color_space(file.header.color_space)) return named;
  if (!file.chromaticities) return find_color_space("srgb");
  const Chromaticities& c = *file.chromaticities;
  for (const ColorSpace& space : color_spaces()) {
    const Chromaticities& s = space.chromaticities;
    if (is_near(c.red, s.red) && is_near(c.green, s.green) && is_near(c.blue, s.blue) && is_near(c.white, s.white))
      return &space;
  }
  return nullptr;
}

}  // namespace

ColorImage read_light_image(const Params& p) {
  ImageFile file = read_rgb(p.file("filename"), p.where("filename"));
  if (file.eight_bit) decode_srgb(file.image);
  float lowest = 0;
  for (float& v : file.image.pixels) lowest = std::min(lowest, v), v = std::max(v, 0.f);
  if (lowest < 0)
    p.warn("filename", fmt::format("the image holds values down to {}: light is not negative, 0 is taken", lowest));
  const ColorSpace* space = space_of(file);
  if (!space) p.warn("filename", "the image has a colour space of its own that is not known: sRGB is taken");
  return {std::move(file.image), space ? space : find_color_space("srgb")};
}

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
  std::map<Rgb, uint32_t> known;
  for (size_t i = 0; i < luminances_.size(); ++i) {
    const Rgb c = rgb_at(file.image, i);
    const auto [it, is_new] = known.emplace(c, uint32_t(colors_.size()));
    texels_.push_back(it->second);
    if (!is_new) continue;
    // Twice the brightest channel leaves the reflectance room on both sides.
    const double peak = 2 * double(std::max({c[0], c[1], c[2]}));
    if (peak == 0) {
      colors_.push_back({SigmoidPolynomial({0, 0, 0}), 0});
      continue;
    }
    const auto fit = fit_reflectance(*file.space, {double(c[0]) / peak, double(c[1]) / peak, double(c[2]) / peak});
    colors_.push_back({fit.reflectance, float(peak)});
  }
}

double LightImage::mean_luminance() const {
  double sum = 0;
  for (const float v : luminances_) sum += double(v);
  return sum / double(luminances_.size());
}

size_t LightImage::texel(int x, int y) const {
  return size_t(std::clamp(y, 0, height_ - 1)) * size_t(width_) + size_t(std::clamp(x, 0, width_ - 1));
}

SampledSpectrum LightImage::share(size_t texel, const SampledWavelengths& lambda) const {
  const Color& c = colors_[texels_[texel]];
  SampledSpectrum s;
  for (int i = 0; i < lambda.count; ++i) s[i] = c.scale * c.reflectance.at(lambda.nm[size_t(i)]);
  return s;
}

SampledSpectrum LightImage::nearest(Vec2 uv, const SampledWavelengths& lambda) const {
  const auto cell = [](float t, int size) { return int(std::clamp(t, 0.f, 1.f) * float(size)); };
  return white_->sample(lambda) * share(texel(cell(uv.x, width_), cell(uv.y, height_)), lambda);
}

SampledSpectrum LightImage::bilinear(Vec2 uv, const SampledWavelengths& lambda) const {
  const float x = std::clamp(uv.x, 0.f, 1.f) * float(width_) - 0.5f;
  const float y = std::clamp(uv.y, 0.f, 1.f) * float(height_) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const int i = int(x0), j = int(y0);
  return white_->sample(lambda) *
         (share(texel(i, j), lambda) * ((1 - fx) * (1 - fy)) + share(texel(i + 1, j), lambda) * (fx * (1 - fy)) +
          share(texel(i, j + 1), lambda) * ((1 - fx) * fy) + share(texel(i + 1, j + 1), lambda) * (fx * fy));
}

}  // namespace frond
