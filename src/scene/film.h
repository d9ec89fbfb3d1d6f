#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/plugin.h"
#include "core/wavelengths.h"

namespace frond {

struct Crop {
  int x0, y0, x1, y1;  ///< pixels; the end is not in it
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

/// Pixels of a window x0 x1 y0 y1 that is given as fractions of a film, ends rounded up as in pbrt.
Crop crop_of_fractions(std::span<const double> window, int width, int height);
/// As far as it lies on the film.
Crop crop_of_pixels(std::span<const int> bounds, int width, int height);

/// What the scene says of the image.
struct FilmSettings {
  int width, height;  ///< full resolution, pixels
  Crop crop;
  std::string filename;
  bool half = false;         ///< EXR with 16-bit floats
  double exposure = 1;       ///< factor from radiance to film
  double max_component = 0;  ///< samples are scaled down to this channel value; infinity: not at all

  /// That a channel of an EXR can have.
  double largest_value() const { return half ? 65504 : double(std::numeric_limits<float>::max()); }
};

/// Refuses, by InputError at `where`, so many films and the pictures that are made of them where this machine has not
/// the memory: Linux promises it, and ends the program when it comes to use it. `advice` ends the message.
void check_memory(const FilmSettings& settings, size_t bands, size_t films, const Location& where,
                  std::string_view advice);

/// The same picture at half the resolution; the crop keeps a pixel at least.
FilmSettings halved(FilmSettings settings);

struct FilmInfo : PluginInfo {
  FilmSettings (*make)(const Params&);
};

/// Sums over the samples of each pixel of the crop, in double precision: of three colours, or of a sensor's bands, of
/// which a sample need not see all. Pixels are independent: threads may work on different ones at the same time.
class Film {
 public:
  struct Pixel {
    std::array<double, 3> sum{};       ///< of colours
    std::array<double, 6> products{};  ///< of colours: 00 11 22 01 02 12
    double weight = 0, leaf = 0;
    int64_t samples = 0;
    int64_t not_finite = 0;  ///< of these samples
  };
  /// Of those samples of a pixel that saw a band.
  struct BandSums {
    double sum = 0, square = 0;
    int64_t samples = 0;
  };

  /// `bands`: how many; 0 for a film of colours. Throws InputError, with the place of the directive, if the pixels need
  /// more memory than the machine has.
  explicit Film(const FilmSettings& settings, const Location& where = {}, size_t bands = 0);

  /// Adds one sample: sensor response, filter weight, and whether the camera ray met a leaf. A response that is no
  /// finite number counts as black, and is counted.
  void add(int x, int y, SensorResponse sensor, double weight, bool leaf);

  const FilmSettings& settings() const { return settings_; }
  /// All sums, row by row: what a render has to keep to be continued later.
  std::span<const Pixel> pixels() const { return pixels_; }
  /// For each pixel in turn, those of its bands; nothing of a film of colours.
  std::span<const BandSums> band_sums() const { return bands_; }
  /// Goes on from sums that `pixels` and `band_sums` gave of a film of the same size and bands.
  void restore(std::span<const Pixel> pixels, std::span<const BandSums> band_sums);
  const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
  /// Mean sensor response, of a film of colours.
  std::array<double, 3> mean(int x, int y) const;
  /// Estimated covariance of `mean`, as 00 11 22 01 02 12; 0 with less than two samples. With low-discrepancy samples
  /// it is an upper bound: it does not know that they repel each other.
  std::array<double, 6> covariance(int x, int y) const;
  /// Mean of the samples that saw a band, and its estimated variance, 0 with less than two of them.
  struct BandMean {
    double mean = 0, variance = 0;
    int64_t samples = 0;
  };
  BandMean band_mean(int x, int y, size_t band) const;
  size_t bands() const { return band_count_; }
  /// Fraction of the samples that saw a leaf first.
  double leaf_fraction(int x, int y) const;
  double foliar_ratio() const;
  /// Samples of all pixels that were no finite numbers.
  int64_t not_finite() const;

 private:
  size_t index(int x, int y) const;
  static void add_color(Pixel& pixel, const SensorResponse& sensor);
  void add_bands(size_t pixel, const SensorResponse& sensor);

  FilmSettings settings_;
  size_t band_count_;
  std::vector<Pixel> pixels_;
  std::vector<BandSums> bands_;  ///< [pixel][band]
};

}  // namespace frond
