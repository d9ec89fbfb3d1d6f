#include "render/film/film_tile.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace frond {
namespace {

/// Largest magnitude of a value that fits both in the sum and in the sum of squares.
constexpr double kBrightest = 0x1p28;
static_assert(kBrightest <= ExactSum<60>::kLargestTerm && kBrightest * kBrightest <= ExactSum<40>::kLargestTerm);

/// 2^exponent for exponents from -1022 to 1023, without the function call of std::ldexp.
double power_of_two(int exponent) { return std::bit_cast<double>(uint64_t(1023 + exponent) << 52); }

/// True if no lane exceeds the bound in magnitude or is NaN.
bool is_within(const Double4& v, double bound) {
  const Double4 size = v < 0 ? -v : v;
  return size[0] <= bound && size[1] <= bound && size[2] <= bound && size[3] <= bound;
}

/// Largest number of samples in an exact sum of doubles.
constexpr size_t kAtOnce = SplatSums::kMost;

/// The nearest value that an ExactSum<40> can add; 0 for NaN and infinity.
double finite_term(double value) {
  constexpr double kMost = ExactSum<40>::kLargestTerm;
  return std::isfinite(value) ? std::clamp(value, -kMost, kMost) : 0;
}

/// Converts a sample's sensor response to the film's colours and units, and clamps it.
class Exposure {
 public:
  explicit Exposure(const FilmFormat& format)
      : has_colors_(format.has_colors()),
        exposure_(format.settings.exposure),
        most_(format.settings.max_component),
        unit_(format.settings.exposure * power_of_two(-format.exponent)) {
    for (size_t c = 0; c < 3; ++c)
      columns_[c] = Double4{format.color.row[0][c], format.color.row[1][c], format.color.row[2][c], 0};
  }

  /// That of buckets: the limit applies to the radiance.
  static Exposure of_buckets(const FilmFormat& format) {
    Exposure exposure(format);
    exposure.has_colors_ = false, exposure.exposure_ = 1;
    exposure.unit_ = format.bucket_exposure() * power_of_two(-format.exponent);
    return exposure;
  }

  /// Returns false if the value was not finite or was clamped to kBrightest.
  bool expose(const FilmTile::Sample& sample, Double4& value) const {
    const std::array<double, kLanes>& response = sample.sensor.value;
    value = Double4{response[0], response[1], response[2], response[3]};
    if (is_within(value, 0)) return true;
    const bool is_finite = std::isfinite((value[0] + value[1]) + (value[2] + value[3]));
    if (!is_finite) value = Double4{};
    // As in pbrt, the limit applies to the sensor's response.
    const double largest = std::max({value[0], value[1], value[2], value[3]}) * exposure_;
    if (has_colors_) value = columns_[0] * value[0] + columns_[1] * value[1] + columns_[2] * value[2];
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

/// Exact sums of the colours of a few samples of moderate brightness, in doubles: colours and their squares are rounded
/// to multiples of a unit. It is faster than ExactSum.
class DoubleSums {
 public:
  /// Returns false, without a change, if the sample is too bright.
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
  static constexpr double kMost = 4;  ///< kAtOnce values up to this have a sum that a double represents exactly
  static constexpr int kBits = 44;
  static constexpr double kUnit = 0x1p-44, kSquareUnit = 0x1p-40;
  static_assert(double(kAtOnce) * kMost / kUnit <= 0x1p53 && double(kAtOnce) * kMost * kMost / kSquareUnit <= 0x1p53);
  /// Adds the value, rounded to the nearest multiple of `unit`.
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

FilmTile::WeightedSums& FilmTile::WeightedSums::operator+=(const WeightedSums& other) {
  for (size_t c = 0; c < 3; ++c) sum[c] += other.sum[c];
  weight += other.weight;
  return *this;
}

FilmTile::BandSplat& FilmTile::BandSplat::operator+=(const BandSplat& other) {
  sum += other.sum, weight += other.weight;
  return *this;
}

Features::Features(const ChannelList& channels, const CameraHit& hit) {
  size_t mean = 0, id = 0;
  for (const ChannelInfo* channel : channels.infos()) {
    if (!channel->value || channel->is_matte()) continue;
    const Triple value = channel->value(hit);
    for (size_t c = 0; c < channel->size(); ++c)
      (channel->kind == ChannelInfo::Kind::mean ? means[mean++] : ids[id++]) = value[c];
  }
}

FilmTile::FilmTile(const FilmFormat& format, const Crop& pixels)
    : band_count_(format.bands),
      mean_count_(format.channels.means()),
      id_count_(format.channels.ids()),
      matte_count_(format.channels.mattes()),
      has_halves_(format.halves),
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
  reached_ = {};
  if (splats_samples() && count > 0)
    reached_ = intersection(widened(pixels, reach_x_, reach_y_), {0, 0, width_, height_});
  const size_t reached = size_t(reached_.width()) * size_t(reached_.height());
  mattes_.assign((splats_samples() ? reached : count) * matte_count_, {});
  splats_.assign(reached, {});
  band_splats_.assign(reached * band_count_, {});
  first_half_paths_ = 0;
  first_half_.assign(has_halves_ ? (splats_samples() ? reached : count) : 0, {});
  rays_ = 0;
  coverage_ = {};
}

struct FilmTile::SplatSample {
  SplatValue value;
  const Sample* sample;
};

void FilmTile::add(const FilmFormat& format, int x, int y, std::span<const Sample> samples, const SplatKernel* kernel) {
  if (samples.size() > kAtOnce) {
    add(format, x, y, samples.first(kAtOnce), kernel);
    return add(format, x, y, samples.subspan(kAtOnce), kernel);
  }
  const size_t at = index(x, y);
  assert(at < pixels_.size());
  Pixel& pixel = pixels_[at];
  const Exposure exposure(format);
  const bool has_colors = format.has_colors();
  DoubleSums modest;
  std::array<SplatSample, kAtOnce> splats;
  size_t splat_count = 0;
  for (const Sample& sample : samples) {
    Double4 value;
    const bool is_kept = exposure.expose(sample, value);
    pixel.weight += static_cast<int64_t>(sample.weight * kWeightsOfOne);
    pixel.leaf += sample.leaf ? 1 : 0;
    pixel.not_finite += is_kept ? 0 : 1;
    ++pixel.samples;
    if (!has_colors) {
      add_bands(x, y, sample, value, kernel);
      continue;
    }
    if (!modest.add(value)) {
      for (size_t i = 0; i < 3; ++i) {
        pixel.sum[i].add(value[i]);
        pixel.square[i].add(value[i] * value[i]);
      }
    }
    if (kernel) splats[splat_count++] = {SplatValue(value), &sample};
  }
  modest.add_to(pixel);
  if (kernel) add_splats(x, y, *kernel, std::span(splats).first(splat_count));
}

void FilmTile::add_buckets(const FilmFormat& format, int x, int y, std::span<const Sample> samples,
                           const SplatKernel* kernel) {
  const Exposure exposure = Exposure::of_buckets(format);
  for (const Sample& sample : samples) {
    Double4 value;
    exposure.expose(sample, value);  // `add` counts values that are not finite
    add_bands(x, y, sample, value, kernel);
  }
}

void FilmTile::add_bands(int x, int y, const Sample& sample, const Double4& value, const SplatKernel* kernel) {
  const SensorResponse& sensor = sample.sensor;
  for (size_t i = 0; i < size_t(sensor.count); ++i) {
    assert(sensor.channel[i] < band_count_);
    BandSums& band = bands_[index(x, y) * band_count_ + sensor.channel[i]];
    band.sum.add(value[i]);
    band.square.add(value[i] * value[i]);
    ++band.samples;
  }
  if (kernel) add_band_splats(x, y, sensor, value, kernel->at(sample.place));
}

/// Calls each(index, column, row) for all pixels of the image that samples of the pixel (x, y) reach. Column and row
/// are 0 at the offset -reach.
template <class Each>
void FilmTile::for_each_reached(int x, int y, const Each& each) {
  const int left = x - reach_x_, top = y - reach_y_;
  const int end_x = std::min(x + reach_x_ + 1, reached_.x1), end_y = std::min(y + reach_y_ + 1, reached_.y1);
  for (int py = std::max(top, reached_.y0); py < end_y; ++py)
    for (int px = std::max(left, reached_.x0); px < end_x; ++px)
      each(reached_index(px, py), size_t(px - left), size_t(py - top));
}

/// Adds the samples of each exponent together, and black samples together with the first exponent's. Sums are exact in
/// any order.
void FilmTile::add_splats(int x, int y, const SplatKernel& kernel, std::span<SplatSample> samples) {
  SplatSums sums(&kernel);
  for (auto begin = samples.begin(); begin != samples.end();) {
    const auto bright = std::find_if(begin, samples.end(), [](const SplatSample& s) { return !s.value.is_black; });
    const int exponent = (bright == samples.end() ? begin : bright)->value.exponent;
    const auto end = std::partition(begin, samples.end(), [exponent](const SplatSample& s) {
      return s.value.is_black || s.value.exponent == exponent;
    });
    sums.restart(exponent);
    for (; begin != end; ++begin) sums.add(begin->sample->place, begin->value);
    add_splats(x, y, sums);
  }
}

void FilmTile::add_splats(int x, int y, const SplatSums& sums) {
  for_each_reached(x, y, [&](size_t at, size_t column, size_t row) {
    WeightedSums& splat = splats_[at];
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
  for (size_t i = 0; i < mean_count_; ++i) mean_sums_[at * mean_count_ + i].add(finite_term(f.means[i]));
  if (std::pair(double(f.from_center), f.sample) < std::pair(hits.nearest_distance, hits.nearest_sample)) {
    hits.nearest_distance = double(f.from_center), hits.nearest_sample = f.sample;
    std::copy_n(f.ids.begin(), id_count_, ids_.data() + at * id_count_);
  }
}

/// Samples with the same key are summed first: most bundles hit few surfaces.
void FilmTile::add_mattes(int x, int y, std::span<const MatteSample> samples, const SplatKernel* kernel) {
  assert(samples.size() <= kAtOnce && bool(kernel) == splats_samples());
  for (size_t list = 0; list < matte_count_; ++list) {
    std::array<bool, kAtOnce> is_done{};
    for (size_t i = 0; i < samples.size(); ++i) {
      if (is_done[i]) continue;
      const MatteKey key = samples[i].keys[list];
      int64_t own = 0;
      std::array<int64_t, size_t(SplatKernel::kMostWidth) * SplatKernel::kMostWidth> sums;
      const auto width = size_t(2 * reach_x_ + 1), height = size_t(2 * reach_y_ + 1);
      if (kernel) std::fill_n(sums.begin(), width * height, 0);
      for (size_t j = i; j < samples.size(); ++j) {
        const MatteSample& sample = samples[j];
        if (sample.keys[list] != key) continue;
        is_done[j] = true;
        own += int64_t(sample.weight * kWeightsOfOne);
        if (!kernel) continue;
        const SplatKernel::Weights weights = kernel->at(sample.place);
        for (size_t row = 0; row < height; ++row)
          for (size_t column = 0; column < width; ++column)
            sums[row * width + column] += int64_t(double(weights.at(column, row)) * kWeightsOfOne);
      }
      if (kernel)
        for_each_reached(x, y, [&](size_t at, size_t column, size_t row) {
          const int64_t weight = sums[row * width + column];
          if (weight != 0) mattes_[at * matte_count_ + list].add(key, weight);
        });
      else
        mattes_[index(x, y) * matte_count_ + list].add(key, own);
    }
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
    std::copy_n(other.ids_.data() + from * id_count_, id_count_, ids_.data() + at * id_count_);
  }
}

double FilmTile::samples_per_pixel() const {
  return double(paths()) / (double(crop_.width()) * double(crop_.height()));
}

double FilmTile::samples_in_first_half() const {
  return double(first_half_paths_) / (double(crop_.width()) * double(crop_.height()));
}

uint64_t FilmTile::paths() const {
  uint64_t samples = 0;
  for (const WorkItem& item : coverage_.items()) samples += item.paths();
  return samples;
}

FilmTile::WeightedSums FilmTile::sums(int x, int y) const {
  return splats_samples() ? splat(x, y) : WeightedSums{pixel(x, y).sum, pixel(x, y).weight};
}

void FilmTile::clear_first_half() {
  first_half_paths_ = 0;
  std::ranges::fill(first_half_, WeightedSums{});
}

void FilmTile::begin_second_half() {
  assert(has_halves_);
  first_half_paths_ = paths();
  const Crop& all = splats_samples() ? reached_ : crop_;
  size_t at = 0;
  for (int y = all.y0; y < all.y1; ++y)
    for (int x = all.x0; x < all.x1; ++x) first_half_[at++] = sums(x, y);
}

void FilmTile::merge_splats(const FilmTile& other) {
  const Crop& c = other.reached_;
  const auto width = size_t(c.width());
  for (int y = c.y0; y < c.y1; ++y) {
    const size_t to = reached_index(c.x0, y), from = other.reached_index(c.x0, y);
    add_all(splats_, to, other.splats_, from, width);
    add_all(band_splats_, to * band_count_, other.band_splats_, from * band_count_, width * band_count_);
    add_all(mattes_, to * matte_count_, other.mattes_, from * matte_count_, width * matte_count_);
    if (other.first_half_paths_ > 0) add_all(first_half_, to, other.first_half_, from, width);
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
    if (!splats_samples())
      add_all(mattes_, to * matte_count_, other.mattes_, from * matte_count_, width * matte_count_);
    if (other.first_half_paths_ > 0 && !splats_samples()) add_all(first_half_, to, other.first_half_, from, width);
  }
  if (splats_samples()) merge_splats(other);
  first_half_paths_ += other.first_half_paths_;
  rays_ += other.rays_;
  return true;
}

}  // namespace frond
