#include "cameras/films.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/wavelengths.h"
#include "spectra/color/film_sensor.h"

namespace frond {
namespace {

/// Pixels along each axis.
constexpr Interval kResolution{1, 65536};
constexpr auto kRgb = std::to_array<Param>({
    {.name = "xresolution",
     .kind = ParamKind::integer,
     .default_value = 1280,
     .unit = "pixels",
     .range = kResolution,
     .doc = "Width."},
    {.name = "yresolution",
     .kind = ParamKind::integer,
     .default_value = 720,
     .unit = "pixels",
     .range = kResolution,
     .doc = "Height."},
    {.name = "cropwindow",
     .kind = ParamKind::real,
     .doc = "Crop x0 x1 y0 y1 as fractions of the film; values outside 0 to 1 are clamped.",
     .list = true},
    {.name = "pixelbounds", .kind = ParamKind::integer, .doc = "Crop x0 x1 y0 y1 in pixels.", .list = true},
    {.name = "filename",
     .kind = ParamKind::string,
     .default_value = std::string_view("frond.exr"),
     .doc = "Output file; -o overrides it."},
    {.name = "savefp16", .kind = ParamKind::boolean, .default_value = false, .doc = "Write EXR with 16-bit floats."},
    {.name = "diagonal",
     .kind = ParamKind::real,
     .default_value = 35.0,
     .unit = "mm",
     .range = kAtLeastZero,
     .doc = "Film diagonal; frond's cameras do not depend on it."},
    {.name = "iso",
     .kind = ParamKind::real,
     .default_value = 100.0,
     .range = kAtLeastZero,
     .doc = "Film speed; 100 with an exposure of 1 s leaves radiance unchanged."},
    {.name = "exposuretime",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .unit = "s",
     .range = kAtLeastZero,
     .doc = "Exposure time."},
    {.name = "sensor",
     .kind = ParamKind::string,
     .default_value = std::string_view("cie1931"),
     .doc = "Sensor response of the film, for wavelengths \"hero\".",
     .choices = kFilmSensors},
    {.name = "whitebalance",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .unit = "K",
     .range = {0, 1e5},
     .doc = "Colour temperature of daylight that becomes white; 0: 6500 K for cameras, no white balance for cie1931."},
    {.name = "maxcomponentvalue",
     .kind = ParamKind::real,
     .range = kAtLeastZero,
     .doc = "Upper limit of a sample's components, which biases the image; by default none."},
});

constexpr std::string_view kCoordinateSystems[] = {"camera", "world"};
/// Parameters of "rgb" and the coordinate system of the geometric channels.
constexpr auto kGbuffer = [] {
  std::array<Param, kRgb.size() + 1> params{};
  std::ranges::copy(kRgb, params.begin());
  params.back() = {.name = "coordinatesystem",
                   .kind = ParamKind::string,
                   .default_value = std::string_view("camera"),
                   .doc = "Coordinate system of positions and normals.",
                   .choices = kCoordinateSystems};
  return params;
}();

/// Number of buckets, as of wavelengths "bands".
constexpr Interval kBuckets{1, 10000};
/// Parameters of "rgb" and the buckets.
constexpr auto kSpectral = [] {
  std::array<Param, kRgb.size() + 3> params{};
  const auto next = std::ranges::copy(kRgb, params.begin()).out;
  next[0] = {.name = "nbuckets",
             .kind = ParamKind::integer,
             .default_value = 16,
             .range = kBuckets,
             .doc = "Number of spectral channels, which divide the wavelengths into equal intervals."};
  next[1] = {.name = "lambdamin",
             .kind = ParamKind::real,
             .default_value = 360.0,
             .unit = "nm",
             .range = kWavelengthRange_nm,
             .doc = "Shortest wavelength."};
  next[2] = {.name = "lambdamax",
             .kind = ParamKind::real,
             .default_value = 830.0,
             .unit = "nm",
             .range = kWavelengthRange_nm,
             .doc = "Longest wavelength; pbrt-v4 refuses more than 830 nm."};
  return params;
}();

/// Returns the crop of "cropwindow", which takes precedence as in pbrt, or of "pixelbounds", or the whole film.
Crop crop_in(const Params& p, int width, int height) {
  auto window = p.reals("cropwindow");
  auto bounds = p.integers("pixelbounds");
  if (!window.empty() && !bounds.empty()) {
    p.warn("pixelbounds", "\"cropwindow\" is given too and is used");
    bounds.clear();
  }
  if (window.size() == 4 && put_in_order(window))
    p.warn("cropwindow", "\"cropwindow\" has its ends the wrong way round: they are exchanged");
  if (bounds.size() == 4 && put_in_order(bounds))
    p.warn("pixelbounds", "\"pixelbounds\" has its ends the wrong way round: they are exchanged");
  Crop crop{0, 0, width, height};
  if (!window.empty()) {
    if (window.size() != 4) fail(p.where("cropwindow"), "\"cropwindow\" takes 4 values, {} given", window.size());
    crop = crop_of_fractions(window, width, height);
  }
  if (!bounds.empty()) {
    if (bounds.size() != 4) fail(p.where("pixelbounds"), "\"pixelbounds\" takes 4 values, {} given", bounds.size());
    crop = crop_of_pixels(bounds, width, height);
  }
  if (crop.width() <= 0 || crop.height() <= 0)
    fail(p.where(), "the crop holds no pixel of the {} x {} film", width, height);
  return crop;
}

/// Returns the name of the image file. pbrt-v4 also writes the formats PFM and QOI; frond writes EXR instead.
std::string file_name(const Params& p) {
  std::filesystem::path name = p.string("filename");
  if (const auto extension = name.extension(); extension == ".pfm" || extension == ".qoi") {
    name.replace_extension(".exr");
    p.warn("filename",
           fmt::format("frond writes no {} files: the image goes to {}", extension.string(), name.string()));
  }
  return name.string();
}

/// Settings that all films share.
FilmSettings make_rgb_film(const Params& p) {
  FilmSettings s;
  s.width = p.integer("xresolution");
  s.height = p.integer("yresolution");
  s.crop = crop_in(p, s.width, s.height);
  s.filename = file_name(p);
  s.half = p.boolean("savefp16");
  // Imaging ratio of pbrt (4th ed., 5.4.2): exposure time times ISO / 100; 1 leaves radiance unchanged.
  s.exposure = p.real("exposuretime") * p.real("iso") / 100;
  s.max_component =
      p.given("maxcomponentvalue") ? p.real("maxcomponentvalue") : std::numeric_limits<double>::infinity();
  (void)p.real("diagonal");
  (void)p.string("sensor"), (void)p.real("whitebalance");  // make_wavelengths uses these parameters
  return s;
}

/// A gbuffer film has the channels of pbrt-v4, by its names, but for dzdx and dzdy, and those that frond adds.
FilmSettings make_gbuffer_film(const Params& p) {
  FilmSettings s = make_rgb_film(p);
  s.channels = {"Albedo",           "position", "N",        "Ns",       "uv",     "Variance",
                "RelativeVariance", "depth",    "material", "instance", "samples"};
  s.features_in_camera_space = p.string("coordinatesystem") == "camera";
  return s;
}

/// make_wavelengths samples the wavelengths of the buckets.
FilmSettings make_spectral_film(const Params& p) {
  FilmSettings s = make_rgb_film(p);
  s.buckets = p.integer("nbuckets");
  s.buckets_nm = {p.real("lambdamin"), p.real("lambdamax")};
  return s;
}

}  // namespace

/// Ends are rounded up, so that adjacent windows neither overlap nor leave gaps.
Crop crop_of_fractions(std::span<const double> window, int width, int height) {
  const auto at = [](double fraction, int size) { return int(std::ceil(std::clamp(fraction, 0.0, 1.0) * size)); };
  return {at(window[0], width), at(window[2], height), at(window[1], width), at(window[3], height)};
}

/// May be empty, if the bounds lie outside of the film.
Crop crop_of_pixels(std::span<const int> bounds, int width, int height) {
  return {std::max(bounds[0], 0), std::max(bounds[2], 0), std::min(bounds[1], width), std::min(bounds[3], height)};
}

/// Sizes are rounded up, so that no part of the image is lost.
FilmSettings halved(FilmSettings s) {
  s.width = (s.width + 1) / 2;
  s.height = (s.height + 1) / 2;
  s.crop.x0 /= 2, s.crop.y0 /= 2;
  s.crop.x1 = (s.crop.x1 + 1) / 2, s.crop.y1 = (s.crop.y1 + 1) / 2;
  return s;
}

extern const FilmInfo rgb_film{{"film", "rgb", "Three colour channels.", "pbrt-v4", kRgb}, make_rgb_film};
extern const FilmInfo gbuffer_film{
    {"film", "gbuffer", "Three colour channels, and data of the first hit of camera rays.", "pbrt-v4", kGbuffer},
    make_gbuffer_film};
extern const FilmInfo spectral_film{
    {"film", "spectral", "Three colour channels, and the mean radiance in intervals of wavelengths.", "pbrt-v4",
     kSpectral},
    make_spectral_film};

}  // namespace frond
