#pragma once

#include "render/film/film.h"

namespace frond {

/// Smallest and largest number of samples of a pixel.
struct SampleCount {
  uint64_t least = 0, most = 0;
};
/// Counts the samples of a tile's pixels.
SampleCount samples_of(const FilmTile& tile);

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

/// Noise of a film with `halves` (Film::half_variance). The upper bound is `z` standard errors above the estimate. A
/// pixel's estimate has one degree of freedom: its variance is at most its mean square. With splatting, the errors of
/// Splatting::correlated_pixels pixels are taken as fully correlated.
NoiseEstimate image_noise(const Film& film, double z, const NoiseUnit& unit = kFilmUnit);

/// Confidence that the noise of a finished adaptive render is at most the target, over all of its noise tests.
inline constexpr double kNoiseConfidence = 0.95;
/// Number of standard errors for noise test `number` of a render, from 1. The test's error probability is the share
/// 1 / (number (number + 1)) of what the confidence leaves; these shares add up to 1 for any number of tests.
double noise_z(int number);

/// Next step of an adaptive render.
struct SamplePlan {
  std::vector<uint64_t> tile_ends;  ///< samples per pixel of each tile
  uint64_t predicted_paths = 0;     ///< number of paths of the whole render until it meets the target
};

/// Fewest samples of a pixel, from which noise is first estimated.
inline constexpr uint64_t kLeastAdaptive = 32;
/// First plan: half of kLeastAdaptive samples in each pixel.
SamplePlan first_plan(const Film& film);
/// Plan that doubles the samples of the tiles without a second half, to `most` at most, and gives the pixels of a tile
/// of merged parts equally many samples; empty if there is nothing to do.
std::optional<SamplePlan> second_half_plan(const Film& film, uint64_t most);

/// Plan that reduces the noise of the image, `now`, to `max_rms`, in `unit`, at the lowest cost: one more ray is to
/// reduce the noise equally in all tiles (Neyman allocation; for independent samples, their number is then proportional
/// to sqrt(variance / rays)). Only whole doublings are planned, because the halves of 2^k samples of a low-discrepancy
/// sequence are the most evenly distributed ones. (If a number is off by a factor f between 2^-1/2 and 2^1/2, the noise
/// of independent samples is (f + 1 / f) / 2 times that of the optimum, 1.02 on average.) There is one doubling at
/// most, so that the next noise test sees its effect, and it ends at `most`.
///
/// The number of samples of a tile depends on its samples. A pixel's mean is therefore biased, by at most the
/// covariance of its noise with its share of the tile's samples (measured in docs/rendering.md).
SamplePlan next_plan(const Film& film, double max_rms, uint64_t most, const NoiseUnit& unit, const NoiseEstimate& now);

}  // namespace frond
