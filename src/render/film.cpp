#include "render/film.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/error.h"

namespace frond {
namespace {

constexpr double kWeightUnit = 0x1p30;

/// Of the values that a sum and the sum of squares can take.
constexpr double kBrightest = 0x1p28;
static_assert(kBrightest <= ExactSum<60>::kLargestTerm && kBrightest * kBrightest <= ExactSum<40>::kLargestTerm);

double variance_of_mean(double sum, double square, double n, double weight) {
  if (n < 2 || weight == 0) return 0;
  const double spread = std::max(square - sum * sum / n, 0.0);  // rounding, where all samples are alike
  return spread * n / ((n - 1) * weight * weight);              // the mean divides by the weights
}

/// From -1022 to 1023; std::ldexp is a call.
double power_of_two(int exponent) { return std::bit_cast<double>(uint64_t(1023 + exponent) << 52); }

/// Whether a value had to be cut off.
bool cut_off(double& value) {
  if (std::abs(value) <= kBrightest) return false;
  value = std::copysign(kBrightest, value);
  return true;
}

double held(float value) {
  constexpr double kMost = ExactSum<40>::kLargestTerm;
  return std::isfinite(value) ? std::clamp(double(value), -kMost, kMost) : 0;
}

int floor_to_tile(int pixel) { return pixel / Film::kTile; }  // pixels are not negative

template <class Sums>
void add_all(std::vector<Sums>& to, size_t at, const std::vector<Sums>& from, size_t from_at, size_t count) {
  for (size_t i = 0; i < count; ++i) to[at + i] += from[from_at + i];
}

}  // namespace

FilmTile::Pixel& FilmTile::Pixel::operator+=(const Pixel& b) {
  for (size_t c = 0; c < 3; ++c) sum[c] += b.sum[c], square[c] += b.square[c];
  weight += b.weight, samples += b.samples, leaf += b.leaf, not_finite += b.not_finite;
  return *this;
}

FilmTile::BandSums& FilmTile::BandSums::operator+=(const BandSums& b) {
  sum += b.sum, square += b.square, samples += b.samples;
  return *this;
}

FilmTile::FeatureSums& FilmTile::FeatureSums::operator+=(const FeatureSums& b) {
  for (size_t c = 0; c < 3; ++c) albedo[c] += b.albedo[c], normal[c] += b.normal[c], position[c] += b.position[c];
  depth += b.depth, hits += b.hits;
  if (std::pair(b.nearest_distance, b.nearest_sample) < std::pair(nearest_distance, nearest_sample)) {
    nearest_distance = b.nearest_distance, nearest_sample = b.nearest_sample;
    material = b.material, instance = b.instance;
  }
  return *this;
}

FilmTile::BlockSums& FilmTile::BlockSums::operator+=(const BlockSums& b) {
  for (size_t c = 0; c < 3; ++c) square[c] += b.square[c];
  blocks += b.blocks;
  return *this;
}

FilmTile::FilmTile(const FilmFormat& format, const Crop& pixels)
    : band_count_(format.bands), has_features_(format.features), has_blocks_(format.blocks) {
  clear(pixels);
}

void FilmTile::clear(const Crop& pixels) {
  crop_ = pixels;
  const size_t count = size_t(pixels.width()) * size_t(pixels.height());
  pixels_.assign(count, {});
  bands_.assign(count * band_count_, {});
  features_.assign(has_features_ ? count : 0, {});
  blocks_.assign(has_blocks_ ? count : 0, {});
  rays_ = 0;
  coverage_ = {};
}

void FilmTile::add(const FilmFormat& format, int x, int y, SensorResponse sensor, double weight, bool leaf) {
  const size_t at = index(x, y);
  assert(at < pixels_.size());
  Pixel& pixel = pixels_[at];
  bool is_lost = !std::isfinite(sensor[0] + sensor[1] + sensor[2] + sensor[3]);
  if (is_lost) sensor.value = {};
  if (band_count_ == 0) sensor = SensorResponse(format.color * sensor.color());
  const FilmSettings& settings = format.settings;
  const double largest = std::max({sensor[0], sensor[1], sensor[2], sensor[3]}) * settings.exposure;
  const double scale = weight * settings.exposure * power_of_two(-format.exponent) *
                       (largest > settings.max_component ? settings.max_component / largest : 1);
  for (double& value : sensor.value) {
    value *= scale;
    is_lost |= cut_off(value);
  }
  for (size_t i = 0; i < size_t(sensor.count); ++i) {
    if (band_count_ == 0) {
      pixel.sum[i].add(sensor[i]);
      pixel.square[i].add(sensor[i] * sensor[i]);
      continue;
    }
    assert(sensor.channel[i] < band_count_);
    BandSums& band = bands_[at * band_count_ + sensor.channel[i]];
    band.sum.add(sensor[i]);
    band.square.add(sensor[i] * sensor[i]);
    ++band.samples;
  }
  pixel.weight += static_cast<int64_t>(weight * kWeightUnit);
  pixel.leaf += leaf ? 1 : 0;
  pixel.not_finite += is_lost ? 1 : 0;
  ++pixel.samples;
}

void FilmTile::add(const FilmFormat& format, int x, int y, const Features& f) {
  FeatureSums one;
  const Triple albedo = format.color * f.albedo.color();
  for (size_t c = 0; c < 3; ++c) {
    one.albedo[c].add(held(float(albedo[c] / format.white[c])));
    one.normal[c].add(held(f.normal[int(c)]));
    one.position[c].add(held(f.position[int(c)]));
  }
  one.depth.add(held(f.depth));
  one.hits = 1;
  one.nearest_distance = f.from_center, one.nearest_sample = f.sample;
  one.material = f.material, one.instance = f.instance;
  features_[index(x, y)] += one;
}

void FilmTile::add_block(int x, int y, const Pixel& before) {
  BlockSums& block = blocks_[index(x, y)];
  const Pixel& after = pixel(x, y);
  for (size_t c = 0; c < 3; ++c) {
    const double mean = (after.sum[c].value() - before.sum[c].value()) / double(kBlock);
    block.square[c].add(mean * mean);
  }
  ++block.blocks;
}

bool FilmTile::merge(const FilmTile& other) {
  Coverage both = coverage_;
  for (const WorkItem& item : other.coverage_.items())
    if (!both.add(item)) return false;
  coverage_ = std::move(both);
  const Crop& c = other.crop_;
  const auto width = size_t(c.width());
  for (int y = c.y0; y < c.y1; ++y) {
    const size_t to = index(c.x0, y), from = other.index(c.x0, y);
    add_all(pixels_, to, other.pixels_, from, width);
    add_all(bands_, to * band_count_, other.bands_, from * band_count_, width * band_count_);
    if (has_features_) add_all(features_, to, other.features_, from, width);
    if (has_blocks_) add_all(blocks_, to, other.blocks_, from, width);
  }
  rays_ += other.rays_;
  return true;
}

Film::Film(const FilmFormat& format, const Location& where)
    : format_(format),
      first_column_(floor_to_tile(format.settings.crop.x0)),
      first_row_(floor_to_tile(format.settings.crop.y0)),
      columns_(floor_to_tile(format.settings.crop.x1 - 1) - first_column_ + 1),
      unit_(power_of_two(format.exponent)),
      locks_(std::make_unique<std::array<std::mutex, kLocks>>()) {
  check_memory(format, 1, where, "--crop renders a part");
  const Crop& crop = format.settings.crop;
  for (int row = first_row_; row * kTile < crop.y1; ++row)
    for (int column = first_column_; column * kTile < crop.x1; ++column)
      tiles_.emplace_back(format_, Crop{std::max(column * kTile, crop.x0), std::max(row * kTile, crop.y0),
                                        std::min((column + 1) * kTile, crop.x1), std::min((row + 1) * kTile, crop.y1)});
}

size_t Film::tile_at(int x, int y) const {
  [[maybe_unused]] const Crop& c = format_.settings.crop;
  assert(x >= c.x0 && x < c.x1 && y >= c.y0 && y < c.y1);
  return size_t(floor_to_tile(y) - first_row_) * size_t(columns_) + size_t(floor_to_tile(x) - first_column_);
}

FilmTile Film::snapshot(size_t i) const {
  const std::lock_guard lock((*locks_)[i % kLocks]);
  return tiles_[i];
}

Coverage Film::coverage(size_t i) const {
  const std::lock_guard lock((*locks_)[i % kLocks]);
  return tiles_[i].coverage();
}

bool Film::merge(size_t i, const FilmTile& part) {
  const std::lock_guard lock((*locks_)[i % kLocks]);
  return tiles_[i].merge(part);
}

Triple Film::mean(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  if (p.weight == 0) return {};
  const double scale = unit_ * kWeightUnit / double(p.weight);
  return {p.sum[0].value() * scale, p.sum[1].value() * scale, p.sum[2].value() * scale};
}

Triple Film::variance(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  Triple v{};
  for (size_t c = 0; c < 3; ++c)
    v[c] = unit_ * unit_ *
           variance_of_mean(p.sum[c].value(), p.square[c].value(), double(p.samples), double(p.weight) / kWeightUnit);
  return v;
}

Triple Film::block_variance(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  const FilmTile::BlockSums& b = tiles_[tile_at(x, y)].blocks(x, y);
  const double weight = double(p.weight) / kWeightUnit / double(FilmTile::kBlock);
  Triple v{};
  for (size_t c = 0; c < 3; ++c)
    v[c] = unit_ * unit_ *
           variance_of_mean(p.sum[c].value() / double(FilmTile::kBlock), b.square[c].value(), double(b.blocks), weight);
  return v;
}

Film::BandMean Film::band_mean(int x, int y, size_t band) const {
  const FilmTile::Pixel& p = pixel(x, y);
  const FilmTile::BandSums& b = tiles_[tile_at(x, y)].band(x, y, band);
  if (b.samples == 0 || p.weight == 0) return {};
  // Few samples see a band, and filter weights may be negative: those of all samples say what one weighs.
  const double n = double(b.samples), weight = n * (double(p.weight) / kWeightUnit) / double(p.samples);
  return {unit_ * b.sum.value() / weight, unit_ * unit_ * variance_of_mean(b.sum.value(), b.square.value(), n, weight),
          b.samples};
}

Film::FeatureMeans Film::features(int x, int y) const {
  const FilmTile::FeatureSums& f = tiles_[tile_at(x, y)].features(x, y);
  FeatureMeans means;
  if (f.hits == 0) return means;
  const auto mean = [&f](const ExactSum<40>& sum) { return sum.value() / double(f.hits); };
  means.albedo = {mean(f.albedo[0]), mean(f.albedo[1]), mean(f.albedo[2])};
  means.normal = {mean(f.normal[0]), mean(f.normal[1]), mean(f.normal[2])};
  means.position = {mean(f.position[0]), mean(f.position[1]), mean(f.position[2])};
  means.depth = mean(f.depth);
  means.material = f.material, means.instance = f.instance, means.hits = f.hits;
  return means;
}

double Film::leaf_fraction(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  return p.samples > 0 ? double(p.leaf) / double(p.samples) : 0;
}

double Film::foliar_ratio() const {
  double leaf = 0, samples = 0;
  for (const FilmTile& tile : tiles_) {
    const Crop& c = tile.pixels();
    for (int y = c.y0; y < c.y1; ++y)
      for (int x = c.x0; x < c.x1; ++x)
        leaf += double(tile.pixel(x, y).leaf), samples += double(tile.pixel(x, y).samples);
  }
  return samples > 0 ? leaf / samples : 0;
}

uint64_t Film::not_finite() const {
  uint64_t count = 0;
  for (const FilmTile& tile : tiles_) {
    const Crop& c = tile.pixels();
    for (int y = c.y0; y < c.y1; ++y)
      for (int x = c.x0; x < c.x1; ++x) count += tile.pixel(x, y).not_finite;
  }
  return count;
}

void check_memory(const FilmFormat& format, size_t films, const Location& where, std::string_view advice) {
  constexpr double kImageBytes = 64, kBandBytes = 48,
                   kFeatureBytes = 96;  // of the picture that is made of a pixel in the end, and its file
  const Crop& crop = format.settings.crop;
  const double pixel = sizeof(FilmTile::Pixel) + kImageBytes +
                       double(format.bands) * (sizeof(FilmTile::BandSums) + kBandBytes) +
                       (format.features ? sizeof(FilmTile::FeatureSums) + kFeatureBytes : 0) +
                       (format.blocks ? sizeof(FilmTile::BlockSums) : 0);
  const double bytes = double(crop.width()) * double(crop.height()) * double(films) * pixel;
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (bytes <= memory) return;
  fail(where, "{} {} x {} pixels{} need {:.1f} GB of memory, this machine has {:.1f} GB: {}",
       films > 1 ? fmt::format("{} films of", films) : "the film's", crop.width(), crop.height(),
       format.bands > 0 ? fmt::format(" of {} bands", format.bands) : "", bytes * 1e-9, memory * 1e-9, advice);
}

}  // namespace frond
