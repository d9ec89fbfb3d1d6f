#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/exact_sum.h"
#include "core/film.h"
#include "core/wavelengths.h"
#include "render/film/channels.h"
#include "render/film/splatting.h"
#include "render/film/work.h"
#include "spectra/matrix3.h"

namespace frond {

/// What a film holds, and in which units.
struct FilmFormat {
  FilmSettings settings;
  size_t bands = 0;           ///< of a sensor; 0: the film has three colours
  ChannelList channels = {};  ///< of what camera rays met first, summed up too
  bool blocks = false;  ///< how blocks of a pixel's samples differ is summed up too: whole blocks have to be rendered
  /// Values are kept in units of 2^exponent: near the image's typical value, of which samples may be 10^-13 to
  /// 10^8. Brighter ones are cut off there, and counted; squares forget what is below 10^-6.
  int exponent = 0;
  Matrix3 color = Matrix3::diagonal({1, 1, 1});  ///< from a path's response to the film's colours
  Triple white = {1, 1, 1};  ///< the film's colours of a path of radiance 1: what an albedo of 1 is measured by
  std::optional<Splatting> splatting = {};  ///< nothing: a pixel has its own samples alone

  /// Pixels whose samples are in the sums.
  const Crop& sampled() const { return splatting ? splatting->sampled : settings.crop; }
};

/// Values of a film's channels, of one sample that met something.
struct Features {
  std::array<double, kMostMeans> means;
  std::array<double, kMostIds> ids;
  float from_center = 0;  ///< distance of the sample from the pixel's centre, pixels
  uint64_t sample = 0;

  Features(const ChannelList& channels, const CameraHit& hit);
};

/// Sums over the samples of some pixels, exact and so the same in any order: of three colours, or of a sensor's bands,
/// of which a sample need not see all. Where samples are shared, also what they give to these pixels and to those
/// around that they reach: a tile has what its own samples give, all of it, and nothing of other tiles' samples.
class FilmTile {
 public:
  struct Pixel {
    std::array<ExactSum<60>, 3> sum{};     ///< of colours
    std::array<ExactSum<40>, 3> square{};  ///< of colours
    int64_t weight = 0;                    ///< in units of 2^-30
    uint64_t samples = 0, leaf = 0;
    uint64_t not_finite = 0;  ///< of these samples; also those too bright for the film
    Pixel& operator+=(const Pixel& other);
    friend bool operator==(const Pixel&, const Pixel&) = default;
  };
  /// Of those samples of a pixel that saw a band.
  struct BandSums {
    ExactSum<60> sum;
    ExactSum<40> square;
    uint64_t samples = 0, unused = 0;  // no padding: its bytes are kept in files
    BandSums& operator+=(const BandSums& other);
    friend bool operator==(const BandSums&, const BandSums&) = default;
  };
  /// Of those samples of a pixel that met something; their sums are with the tile, one for each value.
  struct Hits {
    uint64_t count = 0;
    uint64_t nearest_sample = ~uint64_t{0};  ///< the first of those nearest to the pixel's centre, whose ids hold
    double nearest_distance = INFINITY;      ///< pixels
    friend bool operator==(const Hits&, const Hits&) = default;
  };

  /// Of a pixel's blocks of kBlock samples, which are spread more evenly than any samples: from how much their means
  /// differ follows what noise there is.
  static constexpr uint64_t kBlock = 16;
  struct BlockSums {
    std::array<ExactSum<40>, 3> square{};  ///< of a block's mean
    uint64_t blocks = 0, unused = 0;
    BlockSums& operator+=(const BlockSums& other);
    friend bool operator==(const BlockSums&, const BlockSums&) = default;
  };

  /// What the tile's samples give to a pixel that they reach, each times its weight.
  struct Splat {
    std::array<ExactSum<60>, 3> sum{};  ///< of colours
    int64_t weight = 0, unused = 0;     ///< in units of 2^-30
    Splat& operator+=(const Splat& other);
    friend bool operator==(const Splat&, const Splat&) = default;
  };
  /// The same of those samples that saw a band.
  struct BandSplat {
    ExactSum<60> sum;
    int64_t weight = 0, unused = 0;
    BandSplat& operator+=(const BandSplat& other);
    friend bool operator==(const BandSplat&, const BandSplat&) = default;
  };
  /// Over blocks of kBlock samples of each of the tile's pixels, which give b and weigh c in a pixel that they reach,
  /// on average of these samples: how b - m c differs from block to block, m the pixel's value, tells its noise.
  struct SplatBlocks {
    std::array<ExactSum<40>, 3> square{};   ///< of b
    std::array<ExactSum<40>, 3> product{};  ///< of b c
    ExactSum<40> weight_square{};           ///< of c
    uint64_t blocks = 0, unused = 0;
    SplatBlocks& operator+=(const SplatBlocks& other);
    friend bool operator==(const SplatBlocks&, const SplatBlocks&) = default;
  };

  /// Units that a weight of 1 has.
  static constexpr double kWeightsOfOne = 0x1p30;

  FilmTile(const FilmFormat& format, const Crop& pixels);
  /// Black again, of other pixels.
  void clear(const Crop& pixels);

  /// What a path says of a pixel.
  struct Sample {
    SensorResponse sensor;
    double weight = 1;  ///< by the filter
    bool leaf = false;  ///< the camera ray met a leaf
    Vec2 place = {};    ///< in its pixel, [0, 1)^2: what it weighs in others, where samples are shared
  };
  /// Adds samples of a pixel; the same whether together or one by one. A response that is no finite number counts as
  /// black, one too bright for the film as the brightest that it can hold; both are counted. `kernel`: of a film of
  /// shared samples, all of weight 1.
  void add(const FilmFormat& format, int x, int y, std::span<const Sample> samples,
           const SplatKernel* kernel = nullptr);
  /// What a sample's camera ray met, of a film that has channels for it.
  void add(int x, int y, const Features& features);
  /// That the last kBlock samples of a pixel, which began at `before`, are a block of a film that has blocks.
  void add_block(int x, int y, const Pixel& before);
  /// The same of shared samples: the last kBlock samples of each of the tile's pixels, before which it had `before`.
  void add_block(const std::vector<Splat>& before);
  void add_rays(uint64_t rays) { rays_ += rays; }
  /// The sums of pixels that lie in this tile. False, and nothing changes, where both hold a sample of the same pixel.
  bool merge(const FilmTile& other);
  /// Says that all these samples have been added.
  bool cover(const WorkItem& item) { return coverage_.add(item); }

  const Crop& pixels() const { return crop_; }
  const Coverage& coverage() const { return coverage_; }
  const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
  const BandSums& band(int x, int y, size_t band) const { return bands_[index(x, y) * band_count_ + band]; }
  const Hits& hits(int x, int y) const { return hits_[index(x, y)]; }
  /// Of a channel's value, by its place among those that are means, or ids.
  const ExactSum<40>& mean_sum(int x, int y, size_t i) const { return mean_sums_[index(x, y) * mean_count_ + i]; }
  double id(int x, int y, size_t i) const { return ids_[index(x, y) * id_count_ + i]; }
  const BlockSums& blocks(int x, int y) const { return blocks_[index(x, y)]; }
  /// Pixels of the image that its samples reach; none where samples are not shared.
  const Crop& reached() const { return reached_; }
  const Splat& splat(int x, int y) const { return splats_[reached_index(x, y)]; }
  const std::vector<Splat>& splats() const { return splats_; }
  const BandSplat& band_splat(int x, int y, size_t band) const {
    return band_splats_[reached_index(x, y) * band_count_ + band];
  }
  const SplatBlocks& splat_blocks(int x, int y) const { return splat_blocks_[reached_index(x, y)]; }
  /// On average of its pixels.
  double samples_per_pixel() const;
  /// Traced for its samples.
  uint64_t rays() const { return rays_; }
  friend bool operator==(const FilmTile&, const FilmTile&) = default;

 private:
  friend class PartFile;  // keeps them as they are

  bool shares_samples() const { return reach_x_ >= 0; }
  void add_features(size_t at, const FilmTile& other, size_t from);
  void add_splats(int x, int y, const SplatSums& sums);
  void add_bands(size_t at, const SensorResponse& sensor, const Double4& value);
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
  size_t band_count_, mean_count_, id_count_;
  bool has_blocks_;
  int reach_x_ = -1, reach_y_ = -1;  ///< of a sample; below 0: samples are not shared
  int width_, height_;               ///< of the image
  uint64_t rays_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<BandSums> bands_;            ///< [pixel][band]
  std::vector<Hits> hits_;                 ///< [pixel], where there are means or ids
  std::vector<ExactSum<40>> mean_sums_;    ///< [pixel][value]
  std::vector<double> ids_;                ///< [pixel][value]
  std::vector<BlockSums> blocks_;          ///< [pixel]
  std::vector<Splat> splats_;              ///< [pixel that is reached]
  std::vector<BandSplat> band_splats_;     ///< [pixel that is reached][band]
  std::vector<SplatBlocks> splat_blocks_;  ///< [pixel that is reached]
  Coverage coverage_;
};

}  // namespace frond
