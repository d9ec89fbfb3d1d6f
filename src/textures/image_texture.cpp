#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>

#include "core/error.h"
#include "core/stop.h"
#include "core/texture.h"
#include "image/rgb_file.h"
#include "spectra/color/reflectance_table.h"
#include "textures/clamped.h"
#include "textures/mip_map.h"

namespace frond {
namespace {

/// Names of "filter" and "wrap", as in pbrt-v4, which accepts both spellings of EWA.
constexpr std::string_view kFilters[] = {"bilinear", "point", "trilinear", "ewa", "EWA"};
constexpr std::string_view kWraps[] = {"repeat", "black", "clamp", "octahedralsphere"};

/// Anisotropy is limited, because the cost of a lookup grows with it.
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

/// Parses sRGB, linear or "gamma X". Throws InputError.
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

/// Returns the encoding that the file type determines, as in pbrt-v4: float images are linear, 8-bit images except PNG
/// are sRGB; nullopt for others.
std::optional<ColorEncoding> fixed_encoding(std::string_view extension) {
  constexpr std::string_view kOfFloats[] = {".exr", ".hdr", ".pfm"},
                             kOfBytes[] = {".jpg", ".jpeg", ".tga", ".bmp", ".gif", ".pgm", ".ppm"};
  if (std::ranges::find(kOfFloats, extension) != std::end(kOfFloats)) return ColorEncoding{};
  if (std::ranges::find(kOfBytes, extension) != std::end(kOfBytes)) return ColorEncoding{ColorEncoding::Curve::srgb};
  return {};
}

/// Returns the encoding by file type or parameter; nullopt if it depends on the file's values.
std::optional<ColorEncoding> known_encoding(const Params& p, const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const bool is_given = p.given("encoding");
  if (const auto fixed = fixed_encoding(extension)) {
    if (is_given && parse_encoding(p).curve != fixed->curve)
      p.warn("encoding", fmt::format("values of {} files are {}, as in pbrt-v4: \"encoding\" is ignored", extension,
                                     fixed->curve == ColorEncoding::Curve::linear ? "linear" : "sRGB"));
    return fixed;
  }
  if (is_given) return parse_encoding(p);
  return {};
}

/// Used if neither file type nor parameter determines the encoding.
ColorEncoding default_encoding(const ImageFile& file) {
  return {file.is_encoded ? ColorEncoding::Curve::srgb : ColorEncoding::Curve::linear};
}

/// Scaling, applied before inversion.
struct Scaling {
  float scale;
  bool invert;
  explicit Scaling(const Params& p) : scale(float(p.real("scale"))), invert(p.boolean("invert")) {}
  float operator()(float v) const { return invert ? std::max(0.f, 1 - scale * v) : scale * v; }
  Float4 operator()(Float4 v) const { return invert ? larger(Float4{}, 1.f - scale * v) : scale * v; }
  /// Returns the range of scaled values.
  Interval operator()(const Interval& values) const {
    const double a = double((*this)(float(values.min))), b = double((*this)(float(values.max)));
    return {std::min(a, b), std::max(a, b)};
  }
};

/// Throws InputError for a scale that overflows.
[[noreturn]] void reject_scale(const Params& p) {
  fail(p.where("scale"), "\"scale\" {} makes values of the image infinite", p.real("scale"));
}

/// Returns one channel; see the documentation of "imagemap".
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
    // Order of the file's channels is arbitrary in EXR: they are selected by name.
    constexpr std::array kNames{"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
      const auto channel = image.channel(kNames[c]);
      if (!channel) fail(p.where("filename"), "{} has no channel {}", p.file("filename").string(), kNames[c]);
      rgb[c] = *channel;
    }
  }
  return image.selected(rgb, {"R", "G", "B"});
}

/// An image file, independent of how textures interpret its values.
struct LoadedImage {
  MipMap map;
  Interval values{INFINITY, -INFINITY};  ///< smallest and largest linear value of all texels
  bool is_red_alone = false;             ///< three channels, of which only red is used

  explicit LoadedImage(MipMap m, bool is_red = false) : map(std::move(m)), is_red_alone(is_red) {
    const int channels = map.channels();
    StopPoll poll;
    map.for_each_texel([&](Float4 v) {
      poll();
      for (int c = 0; c < channels; ++c)
        values = {std::min(values.min, double(v[c])), std::max(values.max, double(v[c]))};
    });
  }
};

/// Channels are decoded before they are averaged.
Image mean_of_channels(const Image& image, const ColorEncoding& encoding) {
  Image mean(image.width, image.height, {"Y"});
  StopPoll poll;
  for (size_t i = 0; i < mean.pixels.size(); ++i) {
    poll();
    const float* v = &image.pixels[3 * i];
    mean.pixels[i] = (encoding.decode(v[0]) + encoding.decode(v[1]) + encoding.decode(v[2])) / 3;
  }
  return mean;
}

/// Loads an image for a float texture.
LoadedImage load_numbers(const Params& p, std::optional<ColorEncoding> known) {
  const ImageFile file = read_finite(p, "filename");
  const ColorEncoding encoding = known ? *known : default_encoding(file);
  const MipMap::Options options = options_of(p);
  const Image image = one_channel(p, file.image);
  if (image.channels.size() == 1) return LoadedImage(MipMap(image, encoding, file.eight_bit, options));
  if (options.filter == MipMap::Filter::point || options.filter == MipMap::Filter::ewa)
    return LoadedImage(MipMap(image.selected(std::array<size_t, 1>{0}, {"R"}), encoding, file.eight_bit, options),
                       true);
  return LoadedImage(MipMap(mean_of_channels(image, encoding), {}, false, options));
}

/// Converts linear colours from the file's colour space.
void convert_to_srgb(const ColorSpace& from, Image& image) {
  const Matrix3 m = find_color_space("srgb")->rgb_from_xyz * from.xyz_from_rgb;
  for (size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
    float* v = &image.pixels[i];
    const Triple rgb = m * Triple{double(v[0]), double(v[1]), double(v[2])};
    for (size_t c = 0; c < 3; ++c) v[c] = float(rgb[c]);
  }
}

/// Loads an image for a spectrum texture. 8-bit files keep their bytes, to save memory.
LoadedImage load_colors(const Params& p, std::optional<ColorEncoding> known) {
  ImageFile file = read_rgb(p, "filename");
  const ColorSpace* space = color_space_of(file);
  if (!space) p.warn("filename", "the image's colour space is unknown: sRGB is used");
  if (space && space->name != "srgb" && !file.eight_bit) convert_to_srgb(*space, file.image);
  return LoadedImage(MipMap(file.image, known ? *known : default_encoding(file), file.eight_bit, options_of(p)));
}

/// Loads once for all textures of a scene with equal parameters.
template <class Load>
std::shared_ptr<const LoadedImage> load_shared(const Params& p, SharedWork* shared, std::string_view what,
                                               const Load& load) {
  const std::filesystem::path path = p.file("filename");
  const auto encoding = known_encoding(p, path);
  const MipMap::Options o = options_of(p);
  const std::string key =
      fmt::format("image {} {} {} {} {} {}", what, int(o.filter), int(o.wrap), o.max_anisotropy,
                  encoding ? fmt::format("{} {}", int(encoding->curve), encoding->gamma) : "-", path.string());
  // The key holds all that the texels depend on; scale and inversion are applied by each texture.
  SharedWork own;
  return (shared ? *shared : own).get<LoadedImage>(key, [&] { return load(p, encoding); });
}

/// Image as float texture.
class ImageFloat final : public FloatTexture {
 public:
  ImageFloat(const Params& p, const TexturePlacement& placement)
      : mapping_(p, placement), scaling_(p), image_(load_shared(p, placement.shared, "of numbers", load_numbers)) {
    if (image_->is_red_alone)
      p.warn("filter", fmt::format("filter \"{}\" takes the red channel of this image, as pbrt-v4 does; bilinear and "
                                   "trilinear take alpha, or the mean where there is none",
                                   p.string("filter")));
    set_range(p);
  }
  /// Filtered value, scaled and inverted.
  float evaluate(const TexturePoint& at) const override { return scaling_(image_->map.at(mapping_.at(at))[0]); }
  Interval range() const override { return range_; }
  bool needs_details() const override { return true; }

 private:
  /// Wrap mode black adds 0 to the range.
  void set_range(const Params& p) {
    range_ = scaling_(image_->values);
    if (!std::isfinite(range_.min) || !std::isfinite(range_.max)) reject_scale(p);
    if (p.string("wrap") != "black") return;
    const double beyond = double(scaling_(0.f));
    range_ = {std::min(range_.min, beyond), std::max(range_.max, beyond)};
  }

  TextureMapping mapping_;
  Scaling scaling_;
  std::shared_ptr<const LoadedImage> image_;
  Interval range_{};
};

/// Filters RGB values, and converts the result to a smooth reflectance.
class ImageSpectrum final : public SpectrumTexture {
 public:
  ImageSpectrum(const Params& p, const TexturePlacement& placement)
      : mapping_(p, placement),
        scaling_(p),
        image_(load_shared(p, placement.shared, "of colours", load_colors)),
        table_(ReflectanceTable::srgb()) {
    const Interval values = scaling_(image_->values);
    if (!std::isfinite(values.min) || !std::isfinite(values.max)) reject_scale(p);
    if (values.min < 0 || values.max > 1)
      p.warn("filename", fmt::format("the image holds the value {:.3g}, reflectances are clamped to 0 to 1",
                                     values.min < 0 ? values.min : values.max));
  }
  /// RGB is converted to a smooth reflectance after filtering, by a table.
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    return table_.sample(color(image_->map.at(mapping_.at(at))), lambda);
  }
  /// The spectra are defined over the range of the CIE observer, nm.
  Interval range_nm() const override { return {360, 830}; }
  /// Computed on first use, because it needs all texels.
  float max_value() const override {
    std::call_once(max_found_, [this] {
      // Runs of equal texels are common; a lookup of the maximum is slower than a comparison.
      Float4 last{-1, 0, 0, 0};
      image_->map.for_each_texel([&](Float4 v) {
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
  /// Scaled linear sRGB, clamped to [0, 1], because a reflectance conserves energy.
  Float4 color(Float4 v) const { return clamped_to_unit(scaling_(v)); }

  TextureMapping mapping_;
  Scaling scaling_;
  std::shared_ptr<const LoadedImage> image_;
  const ReflectanceTable& table_;
  mutable std::once_flag max_found_;
  mutable float max_ = 0;  ///< largest reflectance over texels and wavelengths; valid after max_found_
};

constexpr Param kImageMap[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Image file: EXR, PNG, JPEG, HDR, TIFF, PFM, BMP, WebP or TGA.",
     .required = true},
    {.name = "filter",
     .kind = ParamKind::string,
     .default_value = std::string_view("bilinear"),
     .doc = "Filter between texels. All filters select the MIP map level by the footprint.",
     .choices = kFilters},
    {.name = "maxanisotropy",
     .kind = ParamKind::real,
     .default_value = 8.0,
     .range = kAtLeastZero,
     .doc = "Maximum ratio of footprint length to width, for filter ewa; limited to 256."},
    {.name = "wrap",
     .kind = ParamKind::string,
     .default_value = std::string_view("repeat"),
     .doc = "Lookup beyond the image's edge.",
     .choices = kWraps},
    {.name = "encoding",
     .kind = ParamKind::string,
     .doc = "Encoding of the file's values: sRGB, linear or \"gamma X\"; by default sRGB for 8 bits and PNG, else "
            "linear. No "
            "effect on EXR, HDR, PFM; JPEG, TGA and BMP are sRGB."},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor."},
    {.name = "invert",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Use one minus the scaled value, clamped to 0."},
};
/// Parameters of both textures: those of the image and of the mapping.
constexpr auto kImageParams = with_mapping(kImageMap);

}  // namespace

extern const FloatTextureInfo image_float_texture{{"float texture", "imagemap",
                                                   "Image: its alpha, or without alpha the mean of its channels; "
                                                   "with filter point, or ewa without alpha, the first channel.",
                                                   "pbrt-v4", kImageParams},
                                                  make_placed<FloatTexture, ImageFloat>};
extern const SpectrumTextureInfo image_spectrum_texture{
    {"spectrum texture", "imagemap", "Image: its colours as smooth reflectance spectra.", "Jakob and Hanika 2019",
     kImageParams},
    make_placed<SpectrumTexture, ImageSpectrum>};

}  // namespace frond
