#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/texture.h"
#include "image/rgb_file.h"
#include "scene/registry.h"
#include "spectra/color_space.h"
#include "spectra/rgb_upsampling.h"

namespace frond {
namespace {

constexpr std::string_view kFilters[] = {"bilinear", "point"};
constexpr std::string_view kWraps[] = {"repeat", "black", "clamp"};
constexpr std::string_view kEncodings[] = {"sRGB", "linear"};
constexpr std::string_view kMappings[] = {"uv"};

/// How (u, v) meets the image: the mapping, then what lies beyond the edge, then the texels around the point.
class Lookup {
 public:
  Lookup(const Params& p, int width, int height)
      : width_(width),
        height_(height),
        scale_{float(p.real("uscale")), float(p.real("vscale"))},
        delta_{float(p.real("udelta")), float(p.real("vdelta"))},
        wrap_(p.string("wrap")[0]),
        bilinear_(p.string("filter") == "bilinear") {
    (void)p.string("mapping");
  }

  /// Sums texel(index) * weight over the texels that count; beyond a black edge nothing does.
  template <class Texel>
  void each(Vec2 uv, Texel texel) const {
    // v runs up, image rows run down.
    const float x = (uv.x * scale_.x + delta_.x) * float(width_) - 0.5f;
    const float y = (1 - (uv.y * scale_.y + delta_.y)) * float(height_) - 0.5f;
    if (!bilinear_) return one(std::floor(x + 0.5f), std::floor(y + 0.5f), 1, texel);
    const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    one(x0, y0, (1 - fx) * (1 - fy), texel);
    one(x0 + 1, y0, fx * (1 - fy), texel);
    one(x0, y0 + 1, (1 - fx) * fy, texel);
    one(x0 + 1, y0 + 1, fx * fy, texel);
  }

 private:
  template <class Texel>
  void one(float x, float y, float weight, Texel texel) const {
    const int column = wrapped(x, width_), row = wrapped(y, height_);
    if (weight > 0 && column >= 0 && row >= 0) texel(size_t(row) * size_t(width_) + size_t(column), weight);
  }
  /// -1 beyond a black edge.
  int wrapped(float at, int size) const {
    const double n = size, i = double(at);
    if (!std::isfinite(i)) return -1;
    if (wrap_ == 'r') return std::min(int(i - n * std::floor(i / n)), size - 1);
    if (wrap_ == 'b' && (i < 0 || i >= n)) return -1;
    return int(std::clamp(i, 0.0, n - 1));
  }

  int width_, height_;
  Vec2 scale_, delta_;
  char wrap_;
  bool bilinear_;
};

/// Reads the file's R G B (or its one channel, three times), linear, scaled and inverted as the parameters say.
Image load(const Params& p) {
  ImageFile file = read_rgb(p.file("filename"), p.where("filename"));
  const std::string encoding = p.given("encoding") ? p.string("encoding") : file.eight_bit ? "sRGB" : "linear";
  const float scale = float(p.real("scale"));
  const bool invert = p.boolean("invert");
  if (encoding == "sRGB") decode_srgb(file.image);
  for (float& v : file.image.pixels) {
    v *= scale;
    if (invert) v = 1 - v;
    if (!std::isfinite(v)) fail(p.where("scale"), "\"scale\" {} makes values of the image infinite", scale);
  }
  return std::move(file.image);
}

class ImageFloat final : public FloatTexture {
 public:
  explicit ImageFloat(const Params& p) : ImageFloat(p, load(p)) {}
  float evaluate(const TexturePoint& at) const override {
    float sum = 0;
    lookup_.each(at.uv, [&](size_t i, float weight) { sum += weight * values_[i]; });
    return sum;
  }
  Interval range() const override { return range_; }

 private:
  ImageFloat(const Params& p, const Image& image) : lookup_(p, image.width, image.height) {
    for (size_t i = 0; i < image.pixels.size(); i += 3)
      values_.push_back((image.pixels[i] + image.pixels[i + 1] + image.pixels[i + 2]) / 3);
    const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
    range_ = {double(*low), double(*high)};
    if (p.string("wrap") == "black") range_ = {std::min(range_.min, 0.0), std::max(range_.max, 0.0)};
  }

  Lookup lookup_;
  std::vector<float> values_;
  Interval range_;
};

/// Each colour of the image becomes a smooth reflectance once, at load; between texels the reflectances are mixed.
class ImageSpectrum final : public SpectrumTexture {
 public:
  explicit ImageSpectrum(const Params& p) : ImageSpectrum(p, load(p)) {}
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    SampledSpectrum sum;
    lookup_.each(at.uv, [&](size_t i, float weight) {
      const SigmoidPolynomial& s = colors_[texels_[i]];
      for (int lane = 0; lane < lambda.count; ++lane) sum[lane] += weight * s.at(lambda.nm[size_t(lane)]);
    });
    return sum;
  }
  Interval range_nm() const override { return {360, 830}; }
  float max_value() const override { return max_; }

 private:
  ImageSpectrum(const Params& p, const Image& image) : lookup_(p, image.width, image.height) {
    const ColorSpace& space = *find_color_space("srgb");
    std::map<std::array<float, 3>, uint32_t> known;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
      const std::array<float, 3> c{image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
      const auto [it, is_new] = known.emplace(c, uint32_t(colors_.size()));
      if (is_new) add_color(c, space, p.where("filename"));
      texels_.push_back(it->second);
    }
  }
  void add_color(const std::array<float, 3>& c, const ColorSpace& space, const Location& where) {
    for (const float v : c)
      if (!(v >= 0 && v <= 1))
        fail(where, "the image holds the value {}, a reflectance lies in 0 to 1; \"scale\" can bring it there", v);
    colors_.push_back(fit_reflectance(space, {double(c[0]), double(c[1]), double(c[2])}).reflectance);
    max_ = std::max(max_, colors_.back().max_value());
  }

  Lookup lookup_;
  std::vector<uint32_t> texels_;
  std::vector<SigmoidPolynomial> colors_;
  float max_ = 0;
};

constexpr Param kImageMap[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Image file: EXR, PNG, JPEG, HDR or whatever OpenImageIO reads.",
     .required = true},
    {.name = "filter",
     .kind = ParamKind::string,
     .default_value = std::string_view("bilinear"),
     .doc = "Between texels.",
     .choices = kFilters},
    {.name = "wrap",
     .kind = ParamKind::string,
     .default_value = std::string_view("repeat"),
     .doc = "Beyond the image's edge.",
     .choices = kWraps},
    {.name = "encoding",
     .kind = ParamKind::string,
     .doc = "Of the file's values; sRGB by default for 8 bits, else linear.",
     .choices = kEncodings},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."},
    {.name = "invert", .kind = ParamKind::boolean, .default_value = false, .doc = "One minus the value."},
    {.name = "mapping",
     .kind = ParamKind::string,
     .default_value = std::string_view("uv"),
     .doc = "What places the image.",
     .choices = kMappings},
    {.name = "uscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of u."},
    {.name = "vscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of v."},
    {.name = "udelta", .kind = ParamKind::real, .default_value = 0.0, .doc = "Added to u."},
    {.name = "vdelta", .kind = ParamKind::real, .default_value = 0.0, .doc = "Added to v."},
};

template <class Base, class T>
std::unique_ptr<Base> make(const Params& p, const TexturePlacement&) {
  return std::make_unique<T>(p);
}

}  // namespace

extern const FloatTextureInfo image_float_texture{
    {"float texture", "imagemap", "The mean of an image's channels.", "pbrt-v4", kImageMap},
    make<FloatTexture, ImageFloat>};
extern const SpectrumTextureInfo image_spectrum_texture{
    {"spectrum texture", "imagemap", "An image's colours as smooth reflectances.", "Jakob and Hanika 2019", kImageMap},
    make<SpectrumTexture, ImageSpectrum>};

}  // namespace frond
