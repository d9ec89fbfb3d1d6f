#include "render/film.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "system/memory.h"

namespace frond {
namespace {

/// Units that a weight of 1 has.
constexpr double kWeightsOfOne = 0x1p30;

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

/// Whether no lane is larger in magnitude, or no number.
bool is_within(const Double4& v, double bound) {
  const Double4 size = v < 0 ? -v : v;
  return size[0] <= bound && size[1] <= bound && size[2] <= bound && size[3] <= bound;
}

/// Samples that sums in doubles may have.
constexpr size_t kAtOnce = SplatSums::kMost;

double held(double value) {
  constexpr double kMost = ExactSum<40>::kLargestTerm;
  return std::isfinite(value) ? std::clamp(value, -kMost, kMost) : 0;
}

/// Samples that are shared may lie a little outside of the picture.
int floor_to_tile(int pixel) {
  static_assert(Film::kTile == 16);
  return pixel >> 4;
}

/// Samples and what follows from them: how many, their mean, and the sum of squared distances from it.
struct SampleMoments {
  double count, mean, spread;
};
SampleMoments moments_of(double sum, double square, double count) {
  if (count == 0) return {0, 0, 0};
  return {count, sum / count, std::max(square - sum * sum / count, 0.0)};
}

/// What the film sums of a sample's response: in its colours, in its units, cut off where that is too much.
class Exposure {
 public:
  explicit Exposure(const FilmFormat& format)
      : has_colors_(format.bands == 0),
        exposure_(format.settings.exposure),
        most_(format.settings.max_component),
        unit_(format.settings.exposure * power_of_two(-format.exponent)) {
    for (size_t c = 0; c < 3; ++c)
      columns_[c] = Double4{format.color.row[0][c], format.color.row[1][c], format.color.row[2][c], 0};
  }

  /// False where not all of it could be kept.
  bool expose(const FilmTile::Sample& sample, Double4& value) const {
    const std::array<double, kLanes>& response = sample.sensor.value;
    value = Double4{response[0], response[1], response[2], response[3]};
    const bool is_finite = std::isfinite((value[0] + value[1]) + (value[2] + value[3]));
    if (!is_finite) value = Double4{};
    if (has_colors_) value = columns_[0] * value[0] + columns_[1] * value[1] + columns_[2] * value[2];
    const double largest = std::max({value[0], value[1], value[2], value[3]}) * exposure_;
    value *= sample.weight * unit_ * (largest > most_ ? most_ / largest : 1);
    if (is_within(value, kBrightest)) return is_finite;
    for (int i = 0; i < kLanes; ++i)
      value[i] = std::isnan(value[i]) ? 0 : std::clamp(value[i], -kBrightest, kBrightest);
    return false;
  }

 private:
  bool has_colors_;
  double exposure_, most_, unit_;
  std::array<Double4, 3> columns_;
};

/// Sums of a few samples' colours that are not very bright, in doubles: each is rounded to a multiple of a unit, and
/// its square too, so that their sums are exact.
class ModestSums {
 public:
  /// False, and nothing changes, where a sample is too bright.
  bool add(const Double4& color) {
    if (!is_within(color, kMost)) return false;
    add_rounded(color, kUnit, sum_);
    add_rounded(color * color, kSquareUnit, square_);
    return true;
  }
  void add_to(FilmTile::Pixel& pixel) const {
    for (size_t i = 0; i < 3; ++i) {
      pixel.sum[i].add_multiple(int64_t(sum_[i] / kUnit), 60 - kBits);
      pixel.square[i].add_multiple(int64_t(square_[i] / kSquareUnit), 0);
    }
  }

 private:
  static constexpr double kMost = 4;  ///< kAtOnce of this do not leave the range of whole numbers
  static constexpr int kBits = 44;
  static constexpr double kUnit = 0x1p-44, kSquareUnit = 0x1p-40;
  static_assert(double(kAtOnce) * kMost / kUnit <= 0x1p53 && double(kAtOnce) * kMost * kMost / kSquareUnit <= 0x1p53);
  /// To the nearest.
  static void add_rounded(const Double4& value, double unit, Double4& sum) {
    const double rounds = 0x1.8p52 * unit;
    sum += value + rounds - rounds;
  }
  Double4 sum_{}, square_{};
};

template <class Sums>
void add_all(std::vector<Sums>& to, size_t at, const std::vector<Sums>& from, size_t from_at, size_t count) {
  for (size_t i = 0; i < count; ++i) to[at + i] += from[from_at + i];
}

}  // namespace

FilmTile::Pixel& FilmTile::Pixel::operator+=(const Pixel& other) {
  for (size_t c = 0; c < 3; ++c) sum[c] += other.sum[c], square[c] += other.square[c];
  weight += other.weight, samples += other.samples, leaf += other.leaf, not_finite += other.not_finite;
  return *this;
}

FilmTile::BandSums& FilmTile::BandSums::operator+=(const BandSums& other) {
  sum += other.sum, square += other.square, samples += other.samples;
  return *this;
}

FilmTile::Splat& FilmTile::Splat::operator+=(const Splat& other) {
  for (size_t c = 0; c < 3; ++c) sum[c] += other.sum[c];
  weight += other.weight;
  return *this;
}

FilmTile::BandSplat& FilmTile::BandSplat::operator+=(const BandSplat& other) {
  sum += other.sum, weight += other.weight;
  return *this;
}

FilmTile::SplatBlocks& FilmTile::SplatBlocks::operator+=(const SplatBlocks& other) {
  for (size_t c = 0; c < 3; ++c) square[c] += other.square[c], product[c] += other.product[c];
  weight_square += other.weight_square, blocks += other.blocks;
  return *this;
}

Features::Features(const ChannelList& channels, const CameraHit& hit) {
  size_t mean = 0, id = 0;
  for (const ChannelInfo* channel : channels.infos()) {
    if (channel->kind == ChannelInfo::Kind::sample_count) continue;
    const Triple value = channel->value(hit);
    for (size_t c = 0; c < channel->size(); ++c)
      (channel->kind == ChannelInfo::Kind::mean ? means[mean++] : ids[id++]) = value[c];
  }
}

FilmTile::BlockSums& FilmTile::BlockSums::operator+=(const BlockSums& other) {
  for (size_t c = 0; c < 3; ++c) square[c] += other.square[c];
  blocks += other.blocks;
  return *this;
}

FilmTile::FilmTile(const FilmFormat& format, const Crop& pixels)
    : band_count_(format.bands),
      mean_count_(format.channels.means()),
      id_count_(format.channels.ids()),
      has_blocks_(format.blocks),
      width_(format.settings.width),
      height_(format.settings.height) {
  if (const auto& s = format.splatting) reach_x_ = s->reach_x(), reach_y_ = s->reach_y();
  clear(pixels);
}

void FilmTile::clear(const Crop& pixels) {
  crop_ = pixels;
  const size_t count = size_t(pixels.width()) * size_t(pixels.height());
  pixels_.assign(count, {});
  bands_.assign(count * band_count_, {});
  hits_.assign(mean_count_ + id_count_ > 0 ? count : 0, {});
  mean_sums_.assign(count * mean_count_, {});
  ids_.assign(count * id_count_, 0);
  blocks_.assign(has_blocks_ && !shares_samples() ? count : 0, {});
  reached_ = {};
  if (shares_samples() && count > 0)
    reached_ = intersection(widened(pixels, reach_x_, reach_y_), {0, 0, width_, height_});
  const size_t reached = size_t(reached_.width()) * size_t(reached_.height());
  splats_.assign(reached, {});
  band_splats_.assign(reached * band_count_, {});
  splat_blocks_.assign(has_blocks_ ? reached : 0, {});
  rays_ = 0;
  coverage_ = {};
}

void FilmTile::add(const FilmFormat& format, int x, int y, std::span<const Sample> samples, const SplatKernel* kernel) {
  if (samples.size() > kAtOnce) {
    add(format, x, y, samples.first(kAtOnce), kernel);
    return add(format, x, y, samples.subspan(kAtOnce), kernel);
  }
  const size_t at = index(x, y);
  assert(at < pixels_.size());
  Pixel& pixel = pixels_[at];
  const Exposure exposure(format);
  ModestSums modest;
  std::optional<SplatSums> splats;
  for (const Sample& sample : samples) {
    Double4 value;
    const bool is_kept = exposure.expose(sample, value);
    pixel.weight += static_cast<int64_t>(sample.weight * kWeightsOfOne);
    pixel.leaf += sample.leaf ? 1 : 0;
    pixel.not_finite += is_kept ? 0 : 1;
    ++pixel.samples;
    if (band_count_ > 0) {
      add_bands(at, sample.sensor, value);
      if (kernel) add_band_splats(x, y, sample.sensor, value, kernel->at(sample.place));
      continue;
    }
    if (!modest.add(value)) {
      for (size_t i = 0; i < 3; ++i) {
        pixel.sum[i].add(value[i]);
        pixel.square[i].add(value[i] * value[i]);
      }
    }
    if (!kernel) continue;
    const SplatValue splat(value);
    if (!splats || splats->exponent() != splat.exponent) {
      if (splats) add_splats(x, y, *splats);
      splats.emplace(*kernel, splat.exponent);
    }
    splats->add(sample.place, splat);
  }
  if (splats) add_splats(x, y, *splats);
  modest.add_to(pixel);
}

void FilmTile::add_bands(size_t at, const SensorResponse& sensor, const Double4& value) {
  for (size_t i = 0; i < size_t(sensor.count); ++i) {
    assert(sensor.channel[i] < band_count_);
    BandSums& band = bands_[at * band_count_ + sensor.channel[i]];
    band.sum.add(value[i]);
    band.square.add(value[i] * value[i]);
    ++band.samples;
  }
}

/// Calls each(index, column, row) for the pixels of the picture that a pixel's samples reach, counted from -reach.
template <class Each>
void FilmTile::for_each_reached(int x, int y, const Each& each) {
  const int left = x - reach_x_, top = y - reach_y_;
  const int end_x = std::min(x + reach_x_ + 1, reached_.x1), end_y = std::min(y + reach_y_ + 1, reached_.y1);
  for (int py = std::max(top, reached_.y0); py < end_y; ++py)
    for (int px = std::max(left, reached_.x0); px < end_x; ++px)
      each(reached_index(px, py), size_t(px - left), size_t(py - top));
}

void FilmTile::add_splats(int x, int y, const SplatSums& sums) {
  for_each_reached(x, y, [&](size_t at, size_t column, size_t row) {
    Splat& splat = splats_[at];
    for (size_t c = 0; c < 3; ++c) splat.sum[c].add_multiple(sums.sum(column, row, c), sums.shift());
    splat.weight += sums.weight(column, row);
  });
}

void FilmTile::add_band_splats(int x, int y, const SensorResponse& sensor, const Double4& exposed,
                               const SplatKernel::Weights& weights) {
  for (size_t i = 0; i < size_t(sensor.count); ++i) {
    const SplatValue value(Double4{exposed[i], 0, 0, 0});
    for_each_reached(x, y, [&](size_t at, size_t column, size_t row) {
      const auto weight = double(weights.at(column, row));
      BandSplat& band = band_splats_[at * band_count_ + sensor.channel[i]];
      band.sum.add_multiple(SplatValue::whole(value.multiples[0] * weight), value.shift());
      band.weight += int64_t(weight * kWeightsOfOne);
    });
  }
}

void FilmTile::add(int x, int y, const Features& f) {
  const size_t at = index(x, y);
  Hits& hits = hits_[at];
  ++hits.count;
  for (size_t i = 0; i < mean_count_; ++i) mean_sums_[at * mean_count_ + i].add(held(f.means[i]));
  if (std::pair(double(f.from_center), f.sample) < std::pair(hits.nearest_distance, hits.nearest_sample)) {
    hits.nearest_distance = double(f.from_center), hits.nearest_sample = f.sample;
    std::copy_n(f.ids.begin(), id_count_, &ids_[at * id_count_]);
  }
}

void FilmTile::add_features(size_t at, const FilmTile& other, size_t from) {
  Hits& hits = hits_[at];
  const Hits& others = other.hits_[from];
  hits.count += others.count;
  for (size_t i = 0; i < mean_count_; ++i) mean_sums_[at * mean_count_ + i] += other.mean_sums_[from * mean_count_ + i];
  if (std::pair(others.nearest_distance, others.nearest_sample) <
      std::pair(hits.nearest_distance, hits.nearest_sample)) {
    hits.nearest_distance = others.nearest_distance, hits.nearest_sample = others.nearest_sample;
    std::copy_n(&other.ids_[from * id_count_], id_count_, &ids_[at * id_count_]);
  }
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

void FilmTile::add_block(const std::vector<Splat>& before) {
  for (size_t i = 0; i < splats_.size(); ++i) {
    SplatBlocks& block = splat_blocks_[i];
    const double c = double(splats_[i].weight - before[i].weight) / (kWeightsOfOne * double(kBlock));
    for (size_t k = 0; k < 3; ++k) {
      const double b = (splats_[i].sum[k].value() - before[i].sum[k].value()) / double(kBlock);
      block.square[k].add(held(b * b));
      block.product[k].add(held(b * c));
    }
    block.weight_square.add(c * c);
    ++block.blocks;
  }
}

double FilmTile::samples_per_pixel() const {
  uint64_t samples = 0;
  for (const WorkItem& item : coverage_.items()) samples += item.paths();
  return double(samples) / (double(crop_.width()) * double(crop_.height()));
}

void FilmTile::merge_splats(const FilmTile& other) {
  const Crop& c = other.reached_;
  const auto width = size_t(c.width());
  for (int y = c.y0; y < c.y1; ++y) {
    const size_t to = reached_index(c.x0, y), from = other.reached_index(c.x0, y);
    add_all(splats_, to, other.splats_, from, width);
    add_all(band_splats_, to * band_count_, other.band_splats_, from * band_count_, width * band_count_);
    if (has_blocks_) add_all(splat_blocks_, to, other.splat_blocks_, from, width);
  }
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
    for (size_t i = 0; i < (hits_.empty() ? 0 : width); ++i) add_features(to + i, other, from + i);
    if (!blocks_.empty()) add_all(blocks_, to, other.blocks_, from, width);
  }
  if (shares_samples()) merge_splats(other);
  rays_ += other.rays_;
  return true;
}

Film::Film(const FilmFormat& format, const Location& where)
    : format_(format),
      first_column_(floor_to_tile(format.sampled().x0)),
      first_row_(floor_to_tile(format.sampled().y0)),
      columns_(floor_to_tile(format.sampled().x1 - 1) - first_column_ + 1),
      unit_(power_of_two(format.exponent)),
      locks_(std::make_unique<std::array<std::mutex, kLocks>>()) {
  check_memory(format, 1, where, "--crop renders a part");
  const Crop& crop = format.sampled();
  for (int row = first_row_; row * kTile < crop.y1; ++row)
    for (int column = first_column_; column * kTile < crop.x1; ++column)
      tiles_.emplace_back(format_, Crop{std::max(column * kTile, crop.x0), std::max(row * kTile, crop.y0),
                                        std::min((column + 1) * kTile, crop.x1), std::min((row + 1) * kTile, crop.y1)});
}

size_t Film::tile_at(int x, int y) const {
  [[maybe_unused]] const Crop& c = sampled();
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

template <class Each>
void Film::for_each_reaching_tile(int x, int y, const Each& each) const {
  const Crop pixels = format_.splatting->reaching({x, y, x + 1, y + 1});
  for (int row = floor_to_tile(pixels.y0); row <= floor_to_tile(pixels.y1 - 1); ++row)
    for (int column = floor_to_tile(pixels.x0); column <= floor_to_tile(pixels.x1 - 1); ++column)
      each(tiles_[size_t(row - first_row_) * size_t(columns_) + size_t(column - first_column_)]);
}

template <class Each>
void Film::for_each_reaching_pixel(int x, int y, const Each& each) const {
  for_each_reaching_tile(x, y, [&](const FilmTile& tile) {
    const double samples = tile.samples_per_pixel();
    if (samples == 0) return;
    const Crop all = format_.splatting->reaching({x, y, x + 1, y + 1}), &own = tile.pixels();
    for (int py = std::max(all.y0, own.y0); py < std::min(all.y1, own.y1); ++py)
      for (int px = std::max(all.x0, own.x0); px < std::min(all.x1, own.x1); ++px) each(tile, px, py, samples);
  });
}

Film::Gathered Film::gathered(int x, int y) const {
  Gathered all;
  for_each_reaching_tile(x, y, [&](const FilmTile& tile) {
    const double samples = tile.samples_per_pixel();
    if (samples == 0) return;
    const FilmTile::Splat& splat = tile.splat(x, y);
    for (size_t c = 0; c < 3; ++c) all.sum[c] += splat.sum[c].value() / samples;
    all.weight += double(splat.weight) / kWeightsOfOne / samples;
  });
  all.weight = enough_weight(x, y, all.weight,
                             [](const FilmTile& tile, int px, int py) { return double(tile.pixel(px, py).samples); });
  return all;
}

Film::Gathered Film::gathered(int x, int y, size_t band) const {
  Gathered all;
  for_each_reaching_tile(x, y, [&](const FilmTile& tile) {
    const double samples = tile.samples_per_pixel();
    if (samples == 0) return;
    const FilmTile::BandSplat& splat = tile.band_splat(x, y, band);
    all.sum[0] += splat.sum.value() / samples;
    all.weight += double(splat.weight) / kWeightsOfOne / samples;
  });
  all.weight = enough_weight(x, y, all.weight, [band](const FilmTile& tile, int px, int py) {
    return double(tile.band(px, py, band).samples);
  });
  return all;
}

template <class Count>
double Film::enough_weight(int x, int y, double weight, const Count& count) const {
  if (!format_.splatting->has_negative_weights) return weight;
  double expected = 0;
  for_each_reaching_pixel(x, y, [&](const FilmTile& tile, int px, int py, double samples) {
    expected += count(tile, px, py) / samples * format_.splatting->mean(x - px, y - py);
  });
  constexpr double kLeast = 0.25;
  return weight >= kLeast * expected ? weight : std::max(expected, 0.0);
}

template <class Moments>
double Film::splatted_variance(int x, int y, double mean, double weight, const Moments& moments) const {
  if (weight <= 0) return 0;
  double variance = 0, spread = 0, degrees = 0, of_single_samples = 0;
  for_each_reaching_pixel(x, y, [&](const FilmTile& tile, int px, int py, double samples) {
    const SampleMoments m = moments(tile, px, py);
    if (m.count == 0) return;
    // Of one sample's w (L - mean), w and L independent of each other.
    const double w = format_.splatting->mean(x - px, y - py), ww = format_.splatting->square(x - px, y - py),
                 share = m.count / (samples * samples), step = m.mean - mean;
    variance += share * (ww - w * w) * step * step;
    if (m.count < 2) {
      of_single_samples += share * ww;
      return;
    }
    variance += share * ww * m.spread / (m.count - 1);
    spread += m.spread, degrees += m.count - 1;
  });
  if (degrees == 0) return 0;
  variance += of_single_samples * spread / degrees;  // what a single sample does not tell its neighbours do
  return variance / (weight * weight);
}

Triple Film::mean(int x, int y) const {
  if (format_.splatting) {
    const Gathered all = gathered(x, y);
    if (all.weight <= 0) return {};
    const double scale = unit_ / all.weight;
    return {all.sum[0] * scale, all.sum[1] * scale, all.sum[2] * scale};
  }
  const FilmTile::Pixel& p = pixel(x, y);
  if (p.weight == 0) return {};
  const double scale = unit_ * kWeightsOfOne / double(p.weight);
  return {p.sum[0].value() * scale, p.sum[1].value() * scale, p.sum[2].value() * scale};
}

Triple Film::variance(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  Triple v{};
  if (format_.splatting) {
    const Gathered all = gathered(x, y);
    for (size_t c = 0; c < 3; ++c)
      v[c] = unit_ * unit_ *
             splatted_variance(x, y, all.weight > 0 ? all.sum[c] / all.weight : 0, all.weight,
                               [c](const FilmTile& tile, int px, int py) {
                                 const FilmTile::Pixel& own = tile.pixel(px, py);
                                 return moments_of(own.sum[c].value(), own.square[c].value(), double(own.samples));
                               });
    return v;
  }
  for (size_t c = 0; c < 3; ++c)
    v[c] = unit_ * unit_ *
           variance_of_mean(p.sum[c].value(), p.square[c].value(), double(p.samples), double(p.weight) / kWeightsOfOne);
  return v;
}

Triple Film::block_variance_by(const FilmTile& tile, int x, int y, const Gathered& all) const {
  const double samples = tile.samples_per_pixel();
  if (samples == 0 || all.weight <= 0) return {};
  const FilmTile::SplatBlocks& b = tile.splat_blocks(x, y);
  const FilmTile::Splat& splat = tile.splat(x, y);
  constexpr auto kBlock = double(FilmTile::kBlock);
  Triple v{};
  for (size_t c = 0; c < 3; ++c) {
    const double mean = all.sum[c] / all.weight;
    const double rest = (splat.sum[c].value() - mean * double(splat.weight) / kWeightsOfOne) / kBlock;
    const double square = b.square[c].value() - 2 * mean * b.product[c].value() + mean * mean * b.weight_square.value();
    v[c] = unit_ * unit_ * variance_of_mean(rest, square, double(b.blocks), all.weight * samples / kBlock);
  }
  return v;
}

double Film::block_variance_by(size_t tile, int x, int y) const {
  const Triple v = block_variance_by(tiles_[tile], x, y, gathered(x, y));
  return (v[0] + v[1] + v[2]) / 3;
}

Triple Film::block_variance(int x, int y) const {
  if (format_.splatting) {
    const Gathered all = gathered(x, y);
    Triple v{};
    for_each_reaching_tile(x, y, [&](const FilmTile& tile) {
      const Triple by_tile = block_variance_by(tile, x, y, all);
      for (size_t c = 0; c < 3; ++c) v[c] += by_tile[c];
    });
    return v;
  }
  const FilmTile::Pixel& p = pixel(x, y);
  const FilmTile::BlockSums& b = tiles_[tile_at(x, y)].blocks(x, y);
  const double weight = double(p.weight) / kWeightsOfOne / double(FilmTile::kBlock);
  Triple v{};
  for (size_t c = 0; c < 3; ++c)
    v[c] = unit_ * unit_ *
           variance_of_mean(p.sum[c].value() / double(FilmTile::kBlock), b.square[c].value(), double(b.blocks), weight);
  return v;
}

Film::BandMean Film::band_mean(int x, int y, size_t band) const {
  const FilmTile::Pixel& p = pixel(x, y);
  const FilmTile::BandSums& b = tiles_[tile_at(x, y)].band(x, y, band);
  if (format_.splatting) {
    const Gathered all = gathered(x, y, band);
    if (all.weight <= 0) return {};
    const double mean = all.sum[0] / all.weight;
    return {unit_ * mean,
            unit_ * unit_ *
                splatted_variance(x, y, mean, all.weight,
                                  [band](const FilmTile& tile, int px, int py) {
                                    const FilmTile::BandSums& own = tile.band(px, py, band);
                                    return moments_of(own.sum.value(), own.square.value(), double(own.samples));
                                  }),
            b.samples};
  }
  if (b.samples == 0 || p.weight == 0) return {};
  // Few samples see a band, and filter weights may be negative: those of all samples say what one weighs.
  const double n = double(b.samples), weight = n * (double(p.weight) / kWeightsOfOne) / double(p.samples);
  return {unit_ * b.sum.value() / weight, unit_ * unit_ * variance_of_mean(b.sum.value(), b.square.value(), n, weight),
          b.samples};
}

Film::FeatureMeans Film::features(int x, int y) const {
  const FilmTile& tile = tiles_[tile_at(x, y)];
  const ChannelList& channels = format_.channels;
  FeatureMeans result{.hits = tile.hits(x, y).count};
  if (result.hits == 0) return result;
  for (size_t i = 0; i < channels.means(); ++i) result.means[i] = tile.mean_sum(x, y, i).value() / double(result.hits);
  for (size_t i = 0; i < channels.ids(); ++i) result.ids[i] = tile.id(x, y, i);
  return result;
}

double Film::leaf_fraction(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  return p.samples > 0 ? double(p.leaf) / double(p.samples) : 0;
}

double Film::foliar_ratio() const {
  double leaf = 0, samples = 0;
  const Crop& c = settings().crop;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x) leaf += double(pixel(x, y).leaf), samples += double(pixel(x, y).samples);
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
  constexpr double kImageBytes = 64,
                   kBandBytes = 48;  // of the picture that is made of a pixel in the end, and its file
  const Crop& crop = format.settings.crop;
  const double pixel = sizeof(FilmTile::Pixel) + kImageBytes +
                       double(format.bands) * (sizeof(FilmTile::BandSums) + kBandBytes) +
                       double(format.channels.means()) * (sizeof(ExactSum<40>) + sizeof(float)) +
                       double(format.channels.ids()) * (sizeof(double) + sizeof(float)) + sizeof(FilmTile::Hits) +
                       (format.blocks && !format.splatting ? sizeof(FilmTile::BlockSums) : 0);
  double bytes = double(crop.width()) * double(crop.height()) * double(films) * pixel;
  if (const auto& s = format.splatting)
    bytes += double(crop.width()) * double(crop.height()) * double(films) * (1 + 2.0 * s->reach_x() / Film::kTile) *
             (1 + 2.0 * s->reach_y() / Film::kTile) *
             (sizeof(FilmTile::Splat) + double(format.bands) * sizeof(FilmTile::BandSplat) +
              (format.blocks ? sizeof(FilmTile::SplatBlocks) : 0));
  const double memory = machine_memory();
  if (bytes <= memory) return;
  fail(where, "{} {} x {} pixels{} need {:.1f} GB of memory, this machine has {:.1f} GB: {}",
       films > 1 ? fmt::format("{} films of", films) : "the film's", crop.width(), crop.height(),
       format.bands > 0 ? fmt::format(" of {} bands", format.bands) : "", bytes * 1e-9, memory * 1e-9, advice);
}

}  // namespace frond
