#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/texture.h"
#include "image/rgb_file.h"
#include "scene/mip_map.h"
#include "scene/registry.h"
#include "spectra/reflectance_table.h"

namespace frond {
namespace {

constexpr std::string_view kFilters[] = {"bilinear", "point", "trilinear", "ewa", "EWA"};
constexpr std::string_view kWraps[] = {"repeat", "black", "clamp", "octahedralsphere"};

MipMap::Options options_of(const Params& p) {
  using Filter = MipMap::Filter;
  using Wrap = MipMap::Wrap;
  const std::string filter = p.string("filter"), wrap = p.string("wrap");
  constexpr double kMostAnisotropy = 256;
  return {.filter = filter == "point"       ? Filter::point
                    : filter == "bilinear"  ? Filter::bilinear
                    : filter == "trilinear" ? Filter::trilinear
                                            : Filter::ewa,
          .wrap = wrap == "repeat"  ? Wrap::repeat
                  : wrap == "black" ? Wrap::black
                  : wrap == "clamp" ? Wrap::clamp
                                    : Wrap::octahedral_sphere,
          .max_anisotropy = float(std::clamp(p.real("maxanisotropy"), 1.0, kMostAnisotropy))};
}

ColorEncoding parse_encoding(const Params& p) {
  using Curve = ColorEncoding::Curve;
  const std::string text = p.string("encoding");
  if (text == "sRGB") return {Curve::srgb};
  if (text == "linear") return {Curve::linear};
  constexpr std::string_view kGamma = "gamma ";
  float gamma = 0;
  const char* const end = text.data() + text.size();
  if (text.starts_with(kGamma) && std::from_chars(text.data() + kGamma.size(), end, gamma).ptr == end && gamma > 0)
    return {Curve::power, gamma};
  fail(p.where("encoding"), "\"encoding\" is one of sRGB, linear, or gamma and a number above 0, \"{}\" was given",
       text);
}

/// As pbrt-v4: pictures of floats are linear, whatever the scene says.
ColorEncoding encoding_of(const Params& p, const std::filesystem::path& path, const ImageFile& file) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const bool is_given = p.given("encoding");
  if (extension == ".exr" || extension == ".hdr" || extension == ".pfm") {
    if (is_given && parse_encoding(p).curve != ColorEncoding::Curve::linear)
      p.warn("encoding", fmt::format("values of {} files are linear: \"encoding\" is ignored", extension));
    return {};
  }
  if (is_given) return parse_encoding(p);
  return {file.is_encoded ? ColorEncoding::Curve::srgb : ColorEncoding::Curve::linear};
}

/// Scaled first, then inverted.
struct Scaling {
  float scale;
  bool invert;
  explicit Scaling(const Params& p) : scale(float(p.real("scale"))), invert(p.boolean("invert")) {}
  float operator()(float v) const { return invert ? std::max(0.f, 1 - scale * v) : scale * v; }
  Float4 operator()(Float4 v) const { return invert ? larger(Float4{}, 1.f - scale * v) : scale * v; }
};

[[noreturn]] void refuse_scale(const Params& p) {
  fail(p.where("scale"), "\"scale\" {} makes values of the image infinite", p.real("scale"));
}

/// One channel of what is there: see the documentation of "imagemap".
Image one_channel(const Params& p, const Image& image) {
  const std::string filter = p.string("filter");
  if (image.channels.size() == 1) return image;
  const auto alpha = image.channel("A");
  const auto is_opaque = [&] {
    const std::vector<float> values = image.plane(*alpha);
    return std::ranges::all_of(values, [](float v) { return v == 1; });
  };
  const bool has_alpha = alpha && !is_opaque();
  if (has_alpha && filter != "point") return image.selected(std::array{*alpha}, {"A"});
  std::array<size_t, 3> rgb{};
  if (image.channels.size() > 2) {
    constexpr std::array kNames{"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
      const auto channel = image.channel(kNames[c]);
      if (!channel) fail(p.where("filename"), "{} has no channel {}", p.file("filename").string(), kNames[c]);
      rgb[c] = *channel;
    }
  }
  return image.selected(rgb, {"R", "G", "B"});
}

class ImageFloat final : public FloatTexture {
 public:
  ImageFloat(const Params& p, const TexturePlacement& placement) : mapping_(p, placement), scaling_(p) {
    const std::filesystem::path path = p.file("filename");
    const ImageFile file = read_finite(path, p.where("filename"));
    const ColorEncoding encoding = encoding_of(p, path, file);
    const MipMap::Options options = options_of(p);
    Image image = one_channel(p, file.image);
    bool eight_bit = file.eight_bit;
    if (image.channels.size() == 3) {
      if (options.filter == MipMap::Filter::point || options.filter == MipMap::Filter::ewa) {
        image = image.selected(std::array<size_t, 1>{0}, {"R"});
        p.warn("filter", fmt::format("filter \"{}\" takes the red channel of this image, as pbrt-v4 does; bilinear and "
                                     "trilinear take alpha, or the mean where there is none",
                                     p.string("filter")));
      } else {
        image_ = MipMap(mean_of_channels(image, encoding), {}, false, options);
        eight_bit = false;
      }
    }
    if (image.channels.size() == 1) image_ = MipMap(image, encoding, eight_bit, options);
    set_range(p);
  }
  float evaluate(const TexturePoint& at) const override { return scaling_(image_.at(mapping_.at(at))[0]); }
  Interval range() const override { return range_; }
  bool needs_details() const override { return true; }

 private:
  static Image mean_of_channels(const Image& image, const ColorEncoding& encoding) {
    Image mean(image.width, image.height, {"Y"});
    for (size_t i = 0; i < mean.pixels.size(); ++i) {
      const float* v = &image.pixels[3 * i];
      mean.pixels[i] = (encoding.decode(v[0]) + encoding.decode(v[1]) + encoding.decode(v[2])) / 3;
    }
    return mean;
  }
  void set_range(const Params& p) {
    Interval values{INFINITY, -INFINITY};
    const auto add = [&](float v) {
      if (!std::isfinite(v)) refuse_scale(p);
      values = {std::min(values.min, double(v)), std::max(values.max, double(v))};
    };
    image_.each([&](Float4 v) { add(scaling_(v[0])); });
    if (p.string("wrap") == "black") add(scaling_(0.f));
    range_ = values;
  }

  TextureMapping mapping_;
  Scaling scaling_;
  MipMap image_;
  Interval range_{};
};

/// Colours are filtered as they are, and what comes out becomes a smooth reflectance.
class ImageSpectrum final : public SpectrumTexture {
 public:
  ImageSpectrum(const Params& p, const TexturePlacement& placement)
      : mapping_(p, placement), scaling_(p), table_(ReflectanceTable::srgb()) {
    const std::filesystem::path path = p.file("filename");
    ImageFile file = read_rgb(path, p.where("filename"));
    const ColorEncoding encoding = encoding_of(p, path, file);
    image_ = MipMap(file.image, encoding, file.eight_bit, options_of(p));
    Float4 least{}, most{};
    image_.each([&](Float4 v) {
      const Float4 value = scaling_(v);
      most = larger(most, value), least = -larger(-least, -value);
    });
    const float low = std::min({least[0], least[1], least[2]}), high = std::max({most[0], most[1], most[2]});
    if (!std::isfinite(low) || !std::isfinite(high)) refuse_scale(p);
    if (low < 0 || high > 1)
      p.warn("filename", fmt::format("the image holds the value {}, a reflectance lies in 0 to 1: it is clamped",
                                     low < 0 ? low : high));
  }
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    return table_.sample(color(image_.at(mapping_.at(at))), lambda);
  }
  Interval range_nm() const override { return {360, 830}; }
  float max_value() const override {
    std::call_once(max_found_, [this] {
      Float4 last{-1, 0, 0, 0};
      image_.each([&](Float4 v) {
        if (are_equal(v, last)) return;
        last = v;
        const Float4 c = color(v);
        const bool is_grey = c[0] == c[1] && c[1] == c[2];
        max_ = std::max(max_, is_grey ? c[0] : table_.at(c).max_value());
      });
    });
    return max_;
  }
  bool needs_details() const override { return true; }

 private:
  Float4 color(Float4 v) const {
    constexpr Float4 kOne{1, 1, 1, 1};
    const Float4 c = larger(Float4{}, scaling_(v));
    return c < kOne ? c : kOne;
  }

  TextureMapping mapping_;
  Scaling scaling_;
  MipMap image_;
  const ReflectanceTable& table_;
  mutable std::once_flag max_found_;
  mutable float max_ = 0;
};

constexpr Param kImageMap[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Image file: EXR, PNG, JPEG, HDR or whatever OpenImageIO reads.",
     .required = true},
    {.name = "filter",
     .kind = ParamKind::string,
     .default_value = std::string_view("bilinear"),
     .doc = "Between texels; all take the level of a MIP map that the footprint asks for.",
     .choices = kFilters},
    {.name = "maxanisotropy",
     .kind = ParamKind::real,
     .default_value = 8.0,
     .range = kAtLeastZero,
     .doc = "Of filter ewa: longest footprint over its width; 256 at most."},
    {.name = "wrap",
     .kind = ParamKind::string,
     .default_value = std::string_view("repeat"),
     .doc = "Beyond the image's edge.",
     .choices = kWraps},
    {.name = "encoding",
     .kind = ParamKind::string,
     .doc = "Of the file's values: sRGB, linear or \"gamma X\"; sRGB by default for 8 bits and PNG, else linear."},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor."},
    {.name = "invert",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "One minus the scaled value, 0 at least."},
};
constexpr auto kImageParams = with_mapping(kImageMap);

template <class Base, class T>
std::unique_ptr<Base> make(const Params& p, const TexturePlacement& placement) {
  return std::make_unique<T>(p, placement);
}

}  // namespace

extern const FloatTextureInfo image_float_texture{{"float texture", "imagemap",
                                                   "An image's alpha, or where there is none the mean of its channels; "
                                                   "filter point, and ewa without alpha: the first.",
                                                   "pbrt-v4", kImageParams},
                                                  make<FloatTexture, ImageFloat>};
extern const SpectrumTextureInfo image_spectrum_texture{
    {"spectrum texture", "imagemap", "An image's colours as smooth reflectances.", "Jakob and Hanika 2019",
     kImageParams},
    make<SpectrumTexture, ImageSpectrum>};

}  // namespace frond
