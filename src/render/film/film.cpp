#include "render/film/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>

#include "core/error.h"
#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "system/machine.h"

namespace frond {
namespace {

double variance_of_mean(double sum, double square, double n, double weight) {
  if (n < 2 || weight == 0) return 0;
  const double spread = std::max(square - sum * sum / n, 0.0);  // rounding can make it negative if samples are equal
  return spread * n / ((n - 1) * weight * weight);              // the mean is the sum over the weights
}

/// Index of a tile's row or column. With splatting, pixels outside the image, with negative coordinates, have samples.
int floor_to_tile(int pixel) {
  static_assert(Film::kTile == 16);
  return pixel >> 4;
}

/// Number of samples, their mean, and the sum of squared deviations from it.
struct SampleMoments {
  double count, mean, spread;
};
SampleMoments moments_of(double sum, double square, double count) {
  if (count == 0) return {0, 0, 0};
  return {count, sum / count, std::max(square - sum * sum / count, 0.0)};
}

}  // namespace

Film::Film(const FilmFormat& format, const Location& where)
    : format_(format),
      first_column_(floor_to_tile(format.sampled().x0)),
      first_row_(floor_to_tile(format.sampled().y0)),
      columns_(floor_to_tile(format.sampled().x1 - 1) - first_column_ + 1),
      unit_(std::ldexp(1.0, format.exponent)),
      band_unit_(unit_ * (format.has_buckets() ? photometric(ConstantSpectrum(1)) / format.bucket_exposure() : 1)),
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

Film::Hold Film::hold(const Crop& pixels) const {
  const Crop reaching = format_.splatting ? format_.splatting->reaching(pixels) : pixels;
  const size_t first = tile_at(reaching.x0, reaching.y0), last = tile_at(reaching.x1 - 1, reaching.y1 - 1);
  const size_t width = last % columns() - first % columns();
  std::array<bool, kLocks> is_needed{};
  for (size_t row = first; row <= last; row += columns())
    for (size_t i = row; i <= row + width; ++i) is_needed[i % kLocks] = true;
  Hold held;
  for (size_t lock = 0; lock < kLocks; ++lock)  // always in the same order, against deadlocks
    if (is_needed[lock]) held.emplace_back((*locks_)[lock]);
  return held;
}

template <class Each>
void Film::for_each_reaching_tile(int x, int y, const Each& each) const {
  const Crop pixel{x, y, x + 1, y + 1}, pixels = format_.splatting ? format_.splatting->reaching(pixel) : pixel;
  for (int row = floor_to_tile(pixels.y0); row <= floor_to_tile(pixels.y1 - 1); ++row)
    for (int column = floor_to_tile(pixels.x0); column <= floor_to_tile(pixels.x1 - 1); ++column) {
      const FilmTile& tile = tiles_[size_t(row - first_row_) * size_t(columns_) + size_t(column - first_column_)];
      if (const double samples = tile.samples_per_pixel(); samples > 0) each(tile, samples);
    }
}

template <class Each>
void Film::for_each_reaching_pixel(int x, int y, const Each& each) const {
  for_each_reaching_tile(x, y, [&](const FilmTile& tile, double samples) {
    const Crop all = format_.splatting->reaching({x, y, x + 1, y + 1}), &own = tile.pixels();
    for (int py = std::max(all.y0, own.y0); py < std::min(all.y1, own.y1); ++py)
      for (int px = std::max(all.x0, own.x0); px < std::min(all.x1, own.x1); ++px) each(tile, px, py, samples);
  });
}

Film::Gathered Film::gathered(int x, int y) const {
  Gathered all;
  for_each_reaching_tile(x, y, [&](const FilmTile& tile, double samples) {
    const FilmTile::WeightedSums& splat = tile.splat(x, y);
    for (size_t c = 0; c < 3; ++c) all.sum[c] += splat.sum[c].value() / samples;
    all.weight += double(splat.weight) / FilmTile::kWeightsOfOne / samples;
  });
  all.weight = enough_weight(x, y, all.weight,
                             [](const FilmTile& tile, int px, int py) { return double(tile.pixel(px, py).samples); });
  return all;
}

Film::Gathered Film::gathered(int x, int y, size_t band) const {
  Gathered all;
  for_each_reaching_tile(x, y, [&](const FilmTile& tile, double samples) {
    const FilmTile::BandSplat& splat = tile.band_splat(x, y, band);
    all.sum[0] += splat.sum.value() / samples;
    all.weight += double(splat.weight) / FilmTile::kWeightsOfOne / samples;
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
    // Variance of w (L - mean) of one sample, with w and L independent.
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
  variance += of_single_samples * spread / degrees;  // a pixel with one sample takes the variance of its neighbours
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
  const double scale = unit_ * FilmTile::kWeightsOfOne / double(p.weight);
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
           variance_of_mean(p.sum[c].value(), p.square[c].value(), double(p.samples),
                            double(p.weight) / FilmTile::kWeightsOfOne);
  return v;
}

Film::Gathered Film::own(int x, int y) const {
  const FilmTile::Pixel& p = pixel(x, y);
  const double samples = tiles_[tile_at(x, y)].samples_per_pixel();
  if (samples == 0) return {};
  Gathered all{{}, double(p.weight) / FilmTile::kWeightsOfOne / samples};
  for (size_t c = 0; c < 3; ++c) all.sum[c] = p.sum[c].value() / samples;
  return all;
}

/// With D = sum(w (L - m)) / samples, where m is the value of the pixel, the value changed by the difference of D
/// between the first half and all samples, over the weight. (To first order: the pixel is a ratio of sums.)
Triple Film::half_variance_by(const FilmTile& tile, int x, int y, const Gathered& all) const {
  const double samples = tile.samples_per_pixel(), first_samples = tile.samples_in_first_half();
  if (!tile.has_second_half() || all.weight <= 0) return {};
  const FilmTile::WeightedSums whole = tile.sums(x, y), first = tile.first_half(x, y);
  Triple v{};
  for (size_t c = 0; c < 3; ++c) {
    const double mean = all.sum[c] / all.weight;
    const auto deviation = [&](const FilmTile::WeightedSums& s, double n) {
      return (s.sum[c].value() - mean * double(s.weight) / FilmTile::kWeightsOfOne) / n;
    };
    const double change = unit_ * (deviation(whole, samples) - deviation(first, first_samples)) / all.weight;
    v[c] = change * change / (samples / first_samples - 1);
  }
  return v;
}

Triple Film::half_variance(int x, int y) const {
  bool is_known = true;
  Triple v{};
  const Gathered all = format_.splatting ? gathered(x, y) : own(x, y);
  for_each_reaching_tile(x, y, [&](const FilmTile& tile, double) {
    is_known &= tile.has_second_half();
    const Triple by_tile = half_variance_by(tile, x, y, all);
    for (size_t c = 0; c < 3; ++c) v[c] += by_tile[c];
  });
  return is_known ? v : variance(x, y);
}

void Film::clear_first_half(size_t i) {
  const std::lock_guard lock((*locks_)[i % kLocks]);
  tiles_[i].clear_first_half();
}

void Film::begin_second_half(size_t i) {
  const std::lock_guard lock((*locks_)[i % kLocks]);
  tiles_[i].begin_second_half();
}

double Film::own_weight(int x, int y, size_t band) const {
  const FilmTile::Pixel& p = pixel(x, y);
  if (p.samples == 0) return 0;
  // Few samples carry a band, and filter weights can be negative: the mean weight of all samples is more accurate.
  const auto n = double(tiles_[tile_at(x, y)].band(x, y, band).samples);
  return n * (double(p.weight) / FilmTile::kWeightsOfOne) / double(p.samples);
}

double Film::band(int x, int y, size_t band) const {
  if (format_.splatting) {
    const Gathered all = gathered(x, y, band);
    return all.weight > 0 ? band_unit_ * (all.sum[0] / all.weight) : 0;
  }
  const double weight = own_weight(x, y, band);
  return weight == 0 ? 0 : band_unit_ * tiles_[tile_at(x, y)].band(x, y, band).sum.value() / weight;
}

Film::BandMean Film::band_mean(int x, int y, size_t band) const {
  const FilmTile::BandSums& b = tiles_[tile_at(x, y)].band(x, y, band);
  if (format_.splatting) {
    const Gathered all = gathered(x, y, band);
    if (all.weight <= 0) return {};
    const double mean = all.sum[0] / all.weight;
    return {band_unit_ * mean,
            band_unit_ * band_unit_ *
                splatted_variance(x, y, mean, all.weight,
                                  [band](const FilmTile& tile, int px, int py) {
                                    const FilmTile::BandSums& own = tile.band(px, py, band);
                                    return moments_of(own.sum.value(), own.square.value(), double(own.samples));
                                  }),
            b.samples};
  }
  const double weight = own_weight(x, y, band);
  if (weight == 0) return {};
  return {band_unit_ * b.sum.value() / weight,
          band_unit_ * band_unit_ * variance_of_mean(b.sum.value(), b.square.value(), double(b.samples), weight),
          b.samples};
}

uint64_t Film::unsampled() const {
  uint64_t count = 0;
  const Crop& c = settings().crop;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      for (size_t b = 0; b < bands(); ++b)
        count += (format_.splatting ? gathered(x, y, b).weight : own_weight(x, y, b)) <= 0 ? 1 : 0;
  return count;
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

/// As `gathered`, sums of tiles are divided by their samples per pixel.
std::vector<Matte> Film::mattes(int x, int y, size_t list) const {
  std::map<MatteKey, double> weights;
  double all = 0;
  for_each_reaching_tile(x, y, [&](const FilmTile& tile, double samples) {
    for (const MatteList::Entry& e : tile.mattes(x, y, list).entries()) {
      weights[e.key] += double(e.weight) / samples;
      all += double(e.weight) / samples;
    }
  });
  std::vector<Matte> mattes;
  for (const auto& [key, weight] : weights)  // a filter with negative weights can make a coverage negative, or above 1
    if (key != 0 && weight > 0 && all > 0) mattes.push_back({key, std::min(weight / all, 1.0)});
  std::ranges::stable_sort(mattes, std::greater(), &Matte::coverage);
  return mattes;
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

std::string unsampled_text(const Film& film) {
  if (!film.format().has_buckets()) return {};
  const uint64_t missing = film.unsampled();
  const Crop& crop = film.settings().crop;
  const double all = double(crop.width()) * double(crop.height()) * double(film.bands());
  if (missing == 0) return {};
  return fmt::format(
      "{:.2g} % of the values of the spectral channels are 0 because no sample has their wavelengths: "
      "take more samples, or fewer channels",
      100 * double(missing) / all);
}

void check_memory(const FilmFormat& format, size_t films, const Location& where, std::string_view advice) {
  constexpr double kImageBytes = 64,
                   kBandBytes = 48;  // memory for the final image and its file, for each pixel
  const Crop& crop = format.settings.crop;
  const double pixel = sizeof(FilmTile::Pixel) + kImageBytes +
                       double(format.bands) * (sizeof(FilmTile::BandSums) + kBandBytes) +
                       double(format.channels.means()) * (sizeof(ExactSum<40>) + sizeof(float)) +
                       double(format.channels.ids()) * (sizeof(double) + sizeof(float)) + sizeof(FilmTile::Hits) +
                       (format.halves && !format.splatting ? sizeof(FilmTile::WeightedSums) : 0);
  double bytes = double(crop.width()) * double(crop.height()) * double(films) * pixel;
  if (const auto& s = format.splatting)
    bytes +=
        double(crop.width()) * double(crop.height()) * double(films) * (1 + 2.0 * s->reach_x() / Film::kTile) *
        (1 + 2.0 * s->reach_y() / Film::kTile) *
        ((format.halves ? 2 : 1) * sizeof(FilmTile::WeightedSums) + double(format.bands) * sizeof(FilmTile::BandSplat));
  constexpr double kMatteBytes = sizeof(MatteList) + 4 * sizeof(MatteList::Entry) + 12 * sizeof(float);
  bytes +=
      double(crop.width()) * double(crop.height()) * double(films) * double(format.channels.mattes()) * kMatteBytes;
  const double memory = machine_memory();
  if (bytes <= memory) return;
  fail(where, "{} {} x {} pixels{} need {:.1f} GB of memory, this machine has {:.1f} GB: {}",
       films > 1 ? fmt::format("{} films of", films) : "the film's", crop.width(), crop.height(),
       format.bands > 0 ? fmt::format(" of {} bands", format.bands) : "", bytes * 1e-9, memory * 1e-9, advice);
}

}  // namespace frond
