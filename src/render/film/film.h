#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "render/film/film_tile.h"

namespace frond {

/// The tiles of an image's crop; of shared samples, also of the pixels around whose samples reach into it. Its tiles
/// lie on a grid that begins at pixel (0, 0) of the whole image, so that those of its parts match.
class Film {
 public:
  static constexpr int kTile = 16;

  /// Throws InputError, with the place of the directive, if the pixels need more memory than the machine has.
  explicit Film(const FilmFormat& format, const Location& where = {});

  const FilmFormat& format() const { return format_; }
  const FilmSettings& settings() const { return format_.settings; }
  size_t bands() const { return format_.bands; }
  const Crop& sampled() const { return format_.sampled(); }

  size_t tiles() const { return tiles_.size(); }
  /// Of the grid, whose rows follow each other.
  size_t columns() const { return size_t(columns_); }
  const FilmTile& tile(size_t i) const { return tiles_[i]; }
  Crop tile_pixels(size_t i) const { return tiles_[i].pixels(); }
  /// A copy that no thread is at work on.
  FilmTile snapshot(size_t i) const;
  /// What tile `i` holds. Thread-safe.
  Coverage coverage(size_t i) const;
  /// Adds what another thread, or machine, has rendered of tile `i`. Thread-safe. False where there is some of it
  /// already.
  bool merge(size_t i, const FilmTile& part);
  /// Holds off `merge` from all tiles that have a part in these pixels of the image, while it lives: what is read of
  /// the pixels meanwhile is of whole items.
  using Hold = std::vector<std::unique_lock<std::mutex>>;
  [[nodiscard]] Hold hold(const Crop& pixels) const;
  /// The tile of a pixel.
  size_t tile_at(int x, int y) const;
  /// Adds one sample. No two threads at a time.
  void add(int x, int y, const SensorResponse& sensor, double weight, bool leaf) {
    const FilmTile::Sample sample{sensor, weight, leaf};
    tiles_[tile_at(x, y)].add(format_, x, y, {&sample, 1});
  }

  /// Mean colour; of shared samples that weighed by the filter.
  Triple mean(int x, int y) const;
  /// Estimated variance of `mean`; 0 with less than two samples. With low-discrepancy samples it is an upper bound: it
  /// does not know that they repel each other. Of shared samples it follows from how each pixel's own differ, by the
  /// weights that they have in the mean; there it takes a sample's place for independent of what it sees in its pixel.
  Triple variance(int x, int y) const;
  /// The same from how blocks of samples differ, of a film that has them: they know in part how samples repel each
  /// other.
  Triple block_variance(int x, int y) const;
  /// What of it, mean over colours, the samples of one tile make, of shared samples.
  double block_variance_by(size_t tile, int x, int y) const;
  /// Mean of the samples that saw a band, and its estimated variance, 0 with less than two of them.
  struct BandMean {
    double mean = 0, variance = 0;
    uint64_t samples = 0;
  };
  BandMean band_mean(int x, int y, size_t band) const;
  /// The mean alone, which takes far less time.
  double band(int x, int y, size_t band) const;
  /// Values of the film's channels: means over the samples that met something, and ids; 0 where none did.
  struct FeatureMeans {
    std::array<double, kMostMeans> means{};
    std::array<double, kMostIds> ids{};
    uint64_t hits = 0;
  };
  FeatureMeans features(int x, int y) const;
  uint64_t samples(int x, int y) const { return pixel(x, y).samples; }
  /// Fraction of the samples that saw a leaf first.
  double leaf_fraction(int x, int y) const;
  double foliar_ratio() const;
  /// Samples of all pixels that were no finite numbers, or too bright.
  uint64_t not_finite() const;

  friend bool operator==(const Film& a, const Film& b) { return a.tiles_ == b.tiles_; }

 private:
  /// Shared samples that reach a pixel: sum of values times weights, and of weights. Each tile's count by how many
  /// samples its pixels have, so that those which have more do not draw the pixel's centre to their side.
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
  /// What those of a pixel's own samples weigh that saw a band.
  double own_weight(int x, int y, size_t band) const;
  /// The sum of weights, or what it is on average where negative ones leave too little of it.
  template <class Count>
  double enough_weight(int x, int y, double weight, const Count& count) const;
  template <class Moments>
  double splatted_variance(int x, int y, double mean, double weight, const Moments& moments) const;
  Triple block_variance_by(const FilmTile& tile, int x, int y, const Gathered& all) const;

  FilmFormat format_;
  int first_column_, first_row_, columns_;
  double unit_;
  std::vector<FilmTile> tiles_;
  static constexpr size_t kLocks = 64;
  std::unique_ptr<std::array<std::mutex, kLocks>> locks_;  ///< of tiles in turn
};

/// Refuses, by InputError at `where`, so many films and the images that are made of them where this machine has not
/// the memory: Linux promises it, and ends the program when it comes to use it. `advice` ends the message.
void check_memory(const FilmFormat& format, size_t films, const Location& where, std::string_view advice);

}  // namespace frond
