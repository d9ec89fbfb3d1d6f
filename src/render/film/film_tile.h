#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/film.h"
#include "core/math/exact_sum.h"
#include "core/wavelengths.h"
#include "render/film/channels.h"
#include "render/film/mattes.h"
#include "render/film/splatting.h"
#include "render/film/work.h"
#include "spectra/matrix3.h"

namespace frond {

/// Contents of a film and its units.
struct FilmFormat {
  FilmSettings settings;
  size_t bands = 0;           ///< number of spectral bands or buckets; 0: the film has three colours alone
  ChannelList channels = {};  ///< additional channels, from the first hits of camera rays
  bool halves = false;        ///< the film has sums over the first half of its samples, from which noise is estimated
  /// Sums are in units of 2^exponent, which is close to the image's typical value. In these units, values of samples
  /// can range from 10^-13 to 10^8. Brighter values are clamped and counted; in sums of squares, values below 10^-6 are
  /// lost.
  int exponent = 0;
  Matrix3 color = Matrix3::diagonal({1, 1, 1});  ///< from a path's sensor response to the film's colours
  Triple white = {1, 1, 1};                 ///< mean film colours of paths of radiance 1: the colours of an albedo of 1
  std::optional<Splatting> splatting = {};  ///< empty: each sample counts in one pixel

  /// Whether the film has buckets (FilmSettings::buckets), in place of bands, and whether it has colours.
  bool has_buckets() const { return bands > 0 && settings.buckets > 0; }
  bool has_colors() const { return bands == 0 || has_buckets(); }
  /// Exposure of the sums of buckets, which keeps them near those of colours. The image's buckets have none.
  double bucket_exposure() const { return settings.exposure > 0 ? settings.exposure : 1; }
  /// Pixels whose samples are taken.
  const Crop& sampled() const { return splatting ? splatting->sampled : settings.crop; }
};

/// Values of a film's additional channels for one sample with a hit.
struct Features {
  std::array<double, kMostMeans> means;
  std::array<double, kMostIds> ids;
  float from_center = 0;  ///< distance of the sample from the pixel's centre, pixels
  uint64_t sample = 0;    ///< index of the sample

  Features(const ChannelList& channels, const CameraHit& hit);
};

/// Tile of a film: sums over the samples of a rectangle of pixels, of three colours or of spectral bands; a sample need
/// not carry all bands. Sums are exact and do not depend on the order of samples. With splatting, the tile also has
/// sums for the pixels around it that its samples reach: all contributions of its own samples, and none of other
/// tiles'. Not thread-safe. Part files store the arrays of these structures byte by byte: they have no padding.
class FilmTile {
 public:
  /// Sums over the samples of a pixel.
  struct Pixel {
    std::array<ExactSum<60>, 3> sum{};     ///< sums of colours
    std::array<ExactSum<40>, 3> square{};  ///< sums of squared colours
    int64_t weight = 0;                    ///< sum of filter weights, in units of 2^-30
    uint64_t samples = 0, leaf = 0;        ///< number of samples, and of samples whose first hit is a leaf
    uint64_t not_finite = 0;               ///< number of samples that were not finite, or too bright for the film
    Pixel& operator+=(const Pixel& other);
    friend bool operator==(const Pixel&, const Pixel&) = default;
  };
  /// Sums over the samples of a pixel that carry a band.
  struct BandSums {
    ExactSum<60> sum;
    ExactSum<40> square;
    uint64_t samples = 0, unused = 0;
    BandSums& operator+=(const BandSums& other);
    friend bool operator==(const BandSums&, const BandSums&) = default;
  };
  /// Number of samples of a pixel with a hit, and the sample whose ids are stored.
  struct Hits {
    uint64_t count = 0;
    uint64_t nearest_sample = ~uint64_t{0};  ///< sample nearest to the pixel's centre
    double nearest_distance = INFINITY;      ///< its distance from the centre, pixels
    friend bool operator==(const Hits&, const Hits&) = default;
  };

  /// Weighted sums over samples. With splatting, over the tile's samples that reach a pixel.
  struct WeightedSums {
    std::array<ExactSum<60>, 3> sum{};  ///< sums of colours times weights
    int64_t weight = 0, unused = 0;     ///< sum of weights, in units of 2^-30
    WeightedSums& operator+=(const WeightedSums& other);
    friend bool operator==(const WeightedSums&, const WeightedSums&) = default;
  };
  /// With splatting: like WeightedSums, over the samples that carry a band.
  struct BandSplat {
    ExactSum<60> sum;
    int64_t weight = 0, unused = 0;
    BandSplat& operator+=(const BandSplat& other);
    friend bool operator==(const BandSplat&, const BandSplat&) = default;
  };

  /// Fixed-point representation of a weight of 1.
  static constexpr double kWeightsOfOne = 0x1p30;

  FilmTile(const FilmFormat& format, const Crop& pixels);
  /// Resets all sums to 0 and sets the tile's pixels.
  void clear(const Crop& pixels);

  /// Contribution of a path to its pixel.
  struct Sample {
    SensorResponse sensor;
    double weight = 1;  ///< filter weight
    bool leaf = false;  ///< the first hit is a leaf
    Vec2 place = {};    ///< position in the pixel, [0, 1)^2; used with splatting
  };
  /// Adds samples of a pixel. The result does not depend on how samples are divided between calls. A response that is
  /// not finite counts as black, one too bright for the film is clamped; both are counted in `not_finite`. `kernel`
  /// must be set with splatting; then all weights must be 1.
  void add(const FilmFormat& format, int x, int y, std::span<const Sample> samples,
           const SplatKernel* kernel = nullptr);
  /// For a film with buckets: adds the radiance of a pixel's samples, by bucket, to those for which `add` is called
  /// with the same `kernel`.
  void add_buckets(const FilmFormat& format, int x, int y, std::span<const Sample> samples, const SplatKernel* kernel);
  /// Adds the values of additional channels for one sample.
  void add(int x, int y, const Features& features);
  /// Adds the surfaces that the samples of a pixel hit to the lists of mattes. `kernel` as for samples.
  void add_mattes(int x, int y, std::span<const MatteSample> samples, const SplatKernel* kernel);
  /// For a film with `halves`: makes the present sums those of the first half; the next samples are the second half,
  /// which need not have as many.
  void begin_second_half();
  /// Forgets the first half.
  void clear_first_half();
  /// Adds to the number of rays.
  void add_rays(uint64_t rays) { rays_ += rays; }
  /// Adds the sums of another tile, whose pixels must lie in this one. Returns false, without a change, if the tiles
  /// have samples in common.
  bool merge(const FilmTile& other);
  /// Records that the samples of an item have been added; false, without a change, if some were recorded before.
  bool cover(const WorkItem& item) { return coverage_.add(item); }

  const Crop& pixels() const { return crop_; }
  const Coverage& coverage() const { return coverage_; }
  const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
  const BandSums& band(int x, int y, size_t band) const { return bands_[index(x, y) * band_count_ + band]; }
  const Hits& hits(int x, int y) const { return hits_[index(x, y)]; }
  /// Sum of value `i` of the channels of kind mean, and value `i` of the channels of kind nearest.
  const ExactSum<40>& mean_sum(int x, int y, size_t i) const { return mean_sums_[index(x, y) * mean_count_ + i]; }
  double id(int x, int y, size_t i) const { return ids_[index(x, y) * id_count_ + i]; }
  /// List `i` of mattes: over the samples that reach a pixel; without splatting, over the samples of the pixel.
  const MatteList& mattes(int x, int y, size_t i) const {
    return mattes_[(splats_samples() ? reached_index(x, y) : index(x, y)) * matte_count_ + i];
  }
  /// Pixels of the image that the tile's samples reach; empty without splatting.
  const Crop& reached() const { return reached_; }
  const WeightedSums& splat(int x, int y) const { return splats_[reached_index(x, y)]; }
  const BandSplat& band_splat(int x, int y, size_t band) const {
    return band_splats_[reached_index(x, y) * band_count_ + band];
  }
  /// Sums over the samples that reach a pixel; without splatting, over the samples of the pixel. For a film with
  /// `halves`, the same over the first half of the samples.
  WeightedSums sums(int x, int y) const;
  const WeightedSums& first_half(int x, int y) const {
    return first_half_[splats_samples() ? reached_index(x, y) : index(x, y)];
  }
  /// Number of samples of all pixels.
  uint64_t paths() const;
  /// Number of samples, averaged over its pixels, and of those in the first half.
  double samples_per_pixel() const;
  double samples_in_first_half() const;
  /// True if there are samples in the first half and beyond it.
  bool has_second_half() const { return first_half_paths_ > 0 && paths() > first_half_paths_; }
  /// Number of rays traced for its samples.
  uint64_t rays() const { return rays_; }
  friend bool operator==(const FilmTile&, const FilmTile&) = default;

 private:
  friend class PartFile;  // reads and writes the arrays

  bool splats_samples() const { return reach_x_ >= 0; }
  void add_features(size_t at, const FilmTile& other, size_t from);
  struct SplatSample;
  void add_splats(int x, int y, const SplatKernel& kernel, std::span<SplatSample> samples);
  void add_splats(int x, int y, const SplatSums& sums);
  void add_bands(int x, int y, const Sample& sample, const Double4& value, const SplatKernel* kernel);
  void add_band_splats(int x, int y, const SensorResponse& sensor, const Double4& exposed,
                       const SplatKernel::Weights& weights);
  template <class Each>
  void for_each_reached(int x, int y, const Each& each);
  void merge_splats(const FilmTile& other);
  size_t index(int x, int y) const { return size_t(y - crop_.y0) * size_t(crop_.width()) + size_t(x - crop_.x0); }
  size_t reached_index(int x, int y) const {
    return size_t(y - reached_.y0) * size_t(reached_.width()) + size_t(x - reached_.x0);
  }

  Crop crop_, reached_{};
  size_t band_count_, mean_count_, id_count_, matte_count_;
  bool has_halves_;
  int reach_x_ = -1, reach_y_ = -1;  ///< SplatAxis::reach; -1 without splatting
  int width_, height_;               ///< full resolution of the image
  uint64_t rays_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<BandSums> bands_;           ///< [pixel][band]
  std::vector<Hits> hits_;                ///< [pixel], if there are means or ids
  std::vector<ExactSum<40>> mean_sums_;   ///< [pixel][value]
  std::vector<double> ids_;               ///< [pixel][value]
  std::vector<MatteList> mattes_;         ///< [pixel in reached_, without splatting pixel][list]
  std::vector<WeightedSums> splats_;      ///< [pixel in reached_]
  std::vector<BandSplat> band_splats_;    ///< [pixel in reached_][band]
  uint64_t first_half_paths_ = 0;         ///< number of samples of all pixels in the first half
  std::vector<WeightedSums> first_half_;  ///< [pixel in reached_], without splatting [pixel]
  Coverage coverage_;
};

}  // namespace frond
