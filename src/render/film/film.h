#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "render/film/film_tile.h"

namespace frond {

/// Film: sums over the samples of an image's crop, in tiles. With splatting it has tiles also for the pixels around the
/// crop whose samples reach into it. The tiles lie on a grid that begins at pixel (0, 0) of the whole image, so that
/// the tiles of all parts match.
class Film {
 public:
  static constexpr int kTile = 16;  ///< width and height of a tile, pixels

  /// Throws InputError, at the location of the film's directive, if the pixels need more memory than the machine has.
  explicit Film(const FilmFormat& format, const Location& where = {});

  const FilmFormat& format() const { return format_; }
  const FilmSettings& settings() const { return format_.settings; }
  size_t bands() const { return format_.bands; }
  /// Pixels whose samples the film takes.
  const Crop& sampled() const { return format_.sampled(); }

  /// Number of tiles; they are numbered row by row.
  size_t tiles() const { return tiles_.size(); }
  /// Number of tiles in a row.
  size_t columns() const { return size_t(columns_); }
  const FilmTile& tile(size_t i) const { return tiles_[i]; }
  Crop tile_pixels(size_t i) const { return tiles_[i].pixels(); }
  /// Copy of tile `i`. Thread-safe.
  FilmTile snapshot(size_t i) const;
  /// Samples that tile `i` contains. Thread-safe.
  Coverage coverage(size_t i) const;
  /// Adds the sums of `part` to tile `i`. Returns false, without a change, if they have samples in common. Thread-safe.
  bool merge(size_t i, const FilmTile& part);
  /// Blocks `merge` for all tiles that contribute to these pixels of the image, until the result is destroyed. Values
  /// of the pixels that are read meanwhile include complete work items only.
  using Hold = std::vector<std::unique_lock<std::mutex>>;
  [[nodiscard]] Hold hold(const Crop& pixels) const;
  /// Index of the tile that contains a pixel.
  size_t tile_at(int x, int y) const;
  /// Adds one sample. Not thread-safe.
  void add(int x, int y, const SensorResponse& sensor, double weight, bool leaf) {
    const FilmTile::Sample sample{sensor, weight, leaf};
    tiles_[tile_at(x, y)].add(format_, x, y, {&sample, 1});
  }

  /// Colour of a pixel: the mean of its samples, with splatting weighted by the filter.
  Triple mean(int x, int y) const;
  /// Estimated variance of `mean`; 0 for fewer than two samples. For low-discrepancy samples it is an upper bound, as
  /// it ignores their negative correlation. With splatting it is computed from the variances of the samples in each
  /// pixel and their mean weights; the position of a sample in its pixel is taken as independent of its value.
  Triple variance(int x, int y) const;
  /// Estimated variance of `mean` from the difference between the first half of the samples and all of them, for a film
  /// with `halves`. For n independent samples, the first h of which have the mean m_h, (m_n - m_h)^2 / (n / h - 1) has
  /// the expectation of the variance of m_n. A low-discrepancy sequence whose variance falls as n^-a has 2^a - 1 times
  /// its variance for n = 2 h: more, for a > 1. It has one degree of freedom. Falls back on `variance` if the samples
  /// that reach the pixel have no second half.
  Triple half_variance(int x, int y) const;
  /// Makes the samples of tile `i` the first half. Thread-safe.
  void begin_second_half(size_t i);
  /// Forgets the first half of tile `i`. Thread-safe.
  void clear_first_half(size_t i);
  /// Mean of the samples that carry a band, its estimated variance, 0 for fewer than two samples, and their number.
  struct BandMean {
    double mean = 0, variance = 0;
    uint64_t samples = 0;
  };
  BandMean band_mean(int x, int y, size_t band) const;
  /// The mean of band_mean alone, at a much lower cost.
  double band(int x, int y, size_t band) const;
  /// Number of pairs of a pixel and a band that no sample has reached: their mean is 0.
  uint64_t unsampled() const;
  /// Values of the additional channels: means over the samples with a hit, and ids; 0 if there is no hit.
  struct FeatureMeans {
    std::array<double, kMostMeans> means{};
    std::array<double, kMostIds> ids{};
    uint64_t hits = 0;
  };
  FeatureMeans features(int x, int y) const;
  /// Surfaces of list `list` in a pixel, by coverage, the largest first.
  std::vector<Matte> mattes(int x, int y, size_t list) const;
  uint64_t samples(int x, int y) const { return pixel(x, y).samples; }
  /// Share of the pixel's samples whose first hit is a leaf.
  double leaf_fraction(int x, int y) const;
  /// Share of all samples of the crop whose first hit is a leaf.
  double foliar_ratio() const;
  /// Number of samples in all pixels that were not finite, or too bright for the film's exponent.
  uint64_t not_finite() const;

  friend bool operator==(const Film& a, const Film& b) { return a.tiles_ == b.tiles_; }

 private:
  /// With splatting: sums of weighted values and of weights that reach a pixel. The sums of each tile are divided by
  /// its samples per pixel, so that tiles with more samples do not shift the centre of the filter to their side.
  struct Gathered {
    Triple sum{};
    double weight = 0;
  };

  const FilmTile::Pixel& pixel(int x, int y) const { return tiles_[tile_at(x, y)].pixel(x, y); }
  template <class Each>
  void for_each_reaching_tile(int x, int y, const Each& each) const;
  template <class Each>
  void for_each_reaching_pixel(int x, int y, const Each& each) const;
  Gathered gathered(int x, int y) const;
  Gathered gathered(int x, int y, size_t band) const;
  /// Weight of the samples of a pixel that carry a band.
  double own_weight(int x, int y, size_t band) const;
  /// `weight`, or its expected value if negative filter weights make it smaller than a quarter of that.
  template <class Count>
  double enough_weight(int x, int y, double weight, const Count& count) const;
  template <class Moments>
  double splatted_variance(int x, int y, double mean, double weight, const Moments& moments) const;
  Gathered own(int x, int y) const;
  /// Contribution of the samples of one tile to `half_variance`; 0 if they have no second half.
  Triple half_variance_by(const FilmTile& tile, int x, int y, const Gathered& all) const;

  FilmFormat format_;
  int first_column_, first_row_, columns_;
  double unit_, band_unit_;  ///< units of the sums of colours and of bands
  std::vector<FilmTile> tiles_;
  static constexpr size_t kLocks = 64;
  std::unique_ptr<std::array<std::mutex, kLocks>> locks_;  ///< tile i uses lock i % kLocks
};

/// Message about buckets of pixels that no sample has reached; empty if there are none.
std::string unsampled_text(const Film& film);

/// Throws an InputError at `where` if so many films, and the images made from them, need more memory than the machine
/// has. (Linux grants the allocation and terminates the process when it uses the memory.) `advice` ends the message.
void check_memory(const FilmFormat& format, size_t films, const Location& where, std::string_view advice);

}  // namespace frond
