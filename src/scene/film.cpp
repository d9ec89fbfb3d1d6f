#include "scene/film.h"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "scene/registry.h"

namespace frond {
namespace {

constexpr std::array<std::array<size_t, 2>, 6> kPairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

constexpr Interval kResolution{1, 65536};
constexpr std::string_view kSensors[] = {"cie1931"};
constexpr Param kRgb[] = {
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
     .range = {0, 1},
     .doc = "x0 x1 y0 y1 of what to render, as fractions.",
     .list = true},
    {.name = "pixelbounds",
     .kind = ParamKind::integer,
     .doc = "x0 x1 y0 y1 of what to render, in pixels.",
     .list = true},
    {.name = "filename",
     .kind = ParamKind::string,
     .default_value = std::string_view("frond.exr"),
     .doc = "Output; -o goes before it."},
    {.name = "savefp16", .kind = ParamKind::boolean, .default_value = false, .doc = "EXR with 16-bit floats."},
    {.name = "diagonal",
     .kind = ParamKind::real,
     .default_value = 35.0,
     .unit = "mm",
     .range = kAtLeastZero,
     .doc = "Film size; no camera of ours depends on it."},
    {.name = "iso",
     .kind = ParamKind::real,
     .default_value = 100.0,
     .range = kAtLeastZero,
     .doc = "Film speed; 100 and 1 s leave radiance as it is."},
    {.name = "exposuretime",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .unit = "s",
     .range = kAtLeastZero,
     .doc = "Exposure."},
    {.name = "sensor",
     .kind = ParamKind::string,
     .default_value = std::string_view("cie1931"),
     .doc = "Response of the film.",
     .choices = kSensors},
    {.name = "maxcomponentvalue",
     .kind = ParamKind::real,
     .range = kAtLeastZero,
     .doc = "Clamps samples and so biases the image; none by default."},
};

Crop crop_in(const Params& p, int width, int height) {
  const auto window = p.reals("cropwindow");
  const auto bounds = p.integers("pixelbounds");
  if (!window.empty() && !bounds.empty())
    fail(p.where("pixelbounds"), "\"cropwindow\" and \"pixelbounds\" exclude each other");
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

FilmSettings make_rgb_film(const Params& p) {
  FilmSettings s;
  s.width = p.integer("xresolution");
  s.height = p.integer("yresolution");
  s.crop = crop_in(p, s.width, s.height);
  s.filename = p.string("filename");
  s.half = p.boolean("savefp16");
  s.exposure = p.real("exposuretime") * p.real("iso") / 100;
  s.max_component =
      p.given("maxcomponentvalue") ? p.real("maxcomponentvalue") : std::numeric_limits<double>::infinity();
  (void)p.real("diagonal");
  (void)p.string("sensor");
  return s;
}

}  // namespace

Crop crop_of_fractions(std::span<const double> window, int width, int height) {
  const auto at = [](double fraction, int size) { return int(std::ceil(fraction * size)); };
  return {at(window[0], width), at(window[2], height), at(window[1], width), at(window[3], height)};
}

Crop crop_of_pixels(std::span<const int> bounds, int width, int height) {
  return {std::max(bounds[0], 0), std::max(bounds[2], 0), std::min(bounds[1], width), std::min(bounds[3], height)};
}

FilmSettings halved(FilmSettings s) {
  s.width = (s.width + 1) / 2;
  s.height = (s.height + 1) / 2;
  s.crop.x0 /= 2, s.crop.y0 /= 2;
  s.crop.x1 = (s.crop.x1 + 1) / 2, s.crop.y1 = (s.crop.y1 + 1) / 2;
  return s;
}

extern const FilmInfo rgb_film{{"film", "rgb", "Three colour channels.", "pbrt-v4", kRgb}, make_rgb_film};

namespace {

size_t pixels_that_fit(const FilmSettings& settings, size_t bands, const Location& where) {
  check_memory(settings, bands, 1, where, "--crop renders a part");
  return size_t(settings.crop.width()) * size_t(settings.crop.height());
}

}  // namespace

void check_memory(const FilmSettings& settings, size_t bands, size_t films, const Location& where,
                  std::string_view advice) {
  constexpr double kImageBytes = 64,
                   kBandBytes = 48;  // of the picture that is made of a pixel in the end, and its file
  const double count = double(settings.crop.width()) * double(settings.crop.height()) * double(films),
               bytes = count * (sizeof(Film::Pixel) + kImageBytes + double(bands) * kBandBytes);
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (bytes <= memory) return;
  fail(where, "{} {} x {} pixels{} need {:.1f} GB of memory, this machine has {:.1f} GB: {}",
       films > 1 ? fmt::format("{} films of", films) : "the film's", settings.crop.width(), settings.crop.height(),
       bands > 0 ? fmt::format(" of {} bands", bands) : "", bytes * 1e-9, memory * 1e-9, advice);
}

Film::Film(const FilmSettings& settings, const Location& where, size_t bands)
    : settings_(settings),
      band_count_(bands),
      pixels_(pixels_that_fit(settings, bands, where)),
      bands_(pixels_.size() * bands) {}

void Film::restore(std::span<const Pixel> pixels, std::span<const BandSums> band_sums) {
  assert(pixels.size() == pixels_.size() && band_sums.size() == bands_.size());
  pixels_.assign(pixels.begin(), pixels.end());
  bands_.assign(band_sums.begin(), band_sums.end());
}

size_t Film::index(int x, int y) const {
  const Crop& c = settings_.crop;
  assert(x >= c.x0 && x < c.x1 && y >= c.y0 && y < c.y1);
  return size_t(y - c.y0) * size_t(c.width()) + size_t(x - c.x0);
}

void Film::add(int x, int y, SensorResponse sensor, double weight, bool leaf) {
  const size_t at = index(x, y);
  Pixel& pixel = pixels_[at];
  if (!std::isfinite(sensor[0] + sensor[1] + sensor[2] + sensor[3])) {
    sensor.value = {};
    ++pixel.not_finite;
  }
  const double largest = std::max({sensor[0], sensor[1], sensor[2], sensor[3]}) * settings_.exposure;
  const double scale =
      weight * settings_.exposure * (largest > settings_.max_component ? settings_.max_component / largest : 1);
  for (double& value : sensor.value) value *= scale;
  if (band_count_ == 0)
    add_color(pixel, sensor);
  else
    add_bands(at, sensor);
  pixel.weight += weight;
  pixel.leaf += leaf ? 1 : 0;
  ++pixel.samples;
}

void Film::add_color(Pixel& pixel, const SensorResponse& sensor) {
  for (size_t c = 0; c < 3; ++c) pixel.sum[c] += sensor[c];
  for (size_t k = 0; k < 6; ++k) pixel.products[k] += sensor[kPairs[k][0]] * sensor[kPairs[k][1]];
}

void Film::add_bands(size_t pixel, const SensorResponse& sensor) {
  for (size_t i = 0; i < size_t(sensor.count); ++i) {
    assert(sensor.channel[i] < band_count_);
    BandSums& band = bands_[pixel * band_count_ + sensor.channel[i]];
    band.sum += sensor[i];
    band.square += sensor[i] * sensor[i];
    ++band.samples;
  }
}

Film::BandMean Film::band_mean(int x, int y, size_t band) const {
  const Pixel& p = pixel(x, y);
  const BandSums& b = bands_[index(x, y) * band_count_ + band];
  if (b.samples == 0 || p.weight == 0) return {};
  // Few samples see a band, and filter weights may be negative: those of all samples say what one weighs.
  const double n = double(b.samples), weight = n * p.weight / double(p.samples);
  const double spread = b.samples < 2 ? 0 : std::max(b.square - b.sum * b.sum / n, 0.0);
  return {b.sum / weight, spread * n / (std::max(n - 1, 1.0) * weight * weight), b.samples};
}

std::array<double, 3> Film::mean(int x, int y) const {
  const Pixel& p = pixel(x, y);
  if (p.weight == 0) return {};
  return {p.sum[0] / p.weight, p.sum[1] / p.weight, p.sum[2] / p.weight};
}

std::array<double, 6> Film::covariance(int x, int y) const {
  const Pixel& p = pixel(x, y);
  if (p.samples < 2 || p.weight == 0) return {};
  std::array<double, 6> v{};
  const double n = double(p.samples), scale = n / ((n - 1) * p.weight * p.weight);  // the mean divides by the weights
  for (size_t k = 0; k < 6; ++k) v[k] = (p.products[k] - p.sum[kPairs[k][0]] * p.sum[kPairs[k][1]] / n) * scale;
  for (size_t c = 0; c < 3; ++c) v[c] = std::max(v[c], 0.0);  // rounding, where all samples are alike
  return v;
}

double Film::leaf_fraction(int x, int y) const {
  const Pixel& p = pixel(x, y);
  return p.samples > 0 ? p.leaf / double(p.samples) : 0;
}

double Film::foliar_ratio() const {
  double leaf = 0, samples = 0;
  for (const Pixel& p : pixels_) leaf += p.leaf, samples += double(p.samples);
  return samples > 0 ? leaf / samples : 0;
}

int64_t Film::not_finite() const {
  int64_t count = 0;
  for (const Pixel& p : pixels_) count += p.not_finite;
  return count;
}

}  // namespace frond
