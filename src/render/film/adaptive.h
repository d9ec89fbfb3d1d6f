#pragma once

#include "render/film/film.h"

namespace frond {

/// Unit of the noise of each colour, in film units: 1, or the image's means for relative noise.
using NoiseUnit = Triple;
inline constexpr NoiseUnit kFilmUnit{1, 1, 1};
/// The film's unit or, for relative noise, the mean of each colour over all pixels. Throws InputError if one is not
/// above 0.
NoiseUnit noise_unit(const Film& film, bool is_relative);

/// Estimated noise of an image: the mean of the variance over pixels and colours, in squared units.
struct NoiseEstimate {
  double mean_square = 0;
  double upper = 0;  ///< upper confidence bound of mean_square

  /// Square roots.
  double rms() const;
  double upper_rms() const;
};

/// Noise of a film with block statistics. The upper bound is `z` standard errors above the estimate. The relative
/// standard error of each pixel's variance is taken as 1. With splatting, the errors of Splatting::correlated_pixels
/// pixels are taken as fully correlated.
NoiseEstimate image_noise(const Film& film, double z, const NoiseUnit& unit = kFilmUnit);

/// Confidence that the noise of a finished adaptive render is at most the target, over all of its noise tests.
inline constexpr double kNoiseConfidence = 0.95;
/// Largest number of noise tests: at most one for each doubling of the samples, from 2 blocks to 2^30 samples.
inline constexpr size_t kNoiseLooks = 26;
/// Number of standard errors for one noise test (Sidak's correction for kNoiseLooks tests).
double noise_z();

/// Next step of an adaptive render.
struct SamplePlan {
  std::vector<uint64_t> tile_ends;  ///< samples per pixel of each tile, whole blocks
  uint64_t predicted_paths = 0;     ///< number of paths of the whole render until it meets the target
};

/// Number of samples of the first plan: two blocks, the fewest from which noise can be estimated.
inline constexpr uint64_t kLeastAdaptive = 2 * FilmTile::kBlock;
/// First plan: kLeastAdaptive samples in each pixel.
SamplePlan first_plan(const Film& film);

/// Plan that reduces the noise of the image to `max_rms`, in `unit`, at the lowest cost. The number of samples n_t of
/// tile t is proportional to sqrt(variance / rays), so that one more ray reduces the noise equally in all tiles (Neyman
/// allocation). It is at most twice the present number, so that the next noise test sees the effect, and at most `most`
/// rounded down to whole blocks. The variance of a tile is the average of its own estimate and of the mean over the 3 x
/// 3 tiles around it.
///
/// The number of samples of a tile depends on its samples. A pixel's mean is therefore biased, by at most the
/// covariance of its noise with its share of the tile's samples (measured in docs/rendering.md).
SamplePlan next_plan(const Film& film, double max_rms, uint64_t most, const NoiseUnit& unit = kFilmUnit);

}  // namespace frond
