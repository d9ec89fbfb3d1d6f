#pragma once

#include "render/film/film.h"

namespace frond {

/// How much noise an image has: the mean square over its pixels and colours, in the film's units.
struct NoiseEstimate {
  double mean_square = 0;
  double upper = 0;  ///< it is no more than that, with the confidence asked for

  double rms() const;
  double upper_rms() const;
};

/// Of a film that has blocks. `z`: standard errors up to the upper bound; a pixel's own estimate is taken to be
/// uncertain by all of itself, and as many of them as share their samples to be wrong together.
NoiseEstimate image_noise(const Film& film, double z);

/// Confidence that an image's noise is no more than what was asked for, all looks at it together.
inline constexpr double kNoiseConfidence = 0.95;
/// How often the noise may be looked at: each time the samples double at most, from 2 blocks to 2^30 samples.
inline constexpr size_t kNoiseLooks = 26;
/// Standard errors for each look.
double noise_z();

/// What an adaptive render is to have next, tile by tile.
struct SamplePlan {
  std::vector<uint64_t> tile_ends;  ///< whole blocks
  uint64_t predicted_paths = 0;     ///< of the whole render, until its noise is down
};

/// First: two blocks everywhere, the fewest that tell noise.
inline constexpr uint64_t kLeastAdaptive = 2 * FilmTile::kBlock;
SamplePlan first_plan(const Film& film);

/// Where samples do most against the image's noise: to bring it down to `max_rms`, tile t gets so many that the last
/// ray in each takes as much of it away, n_t proportional to sqrt(variance / rays) (Neyman's allocation). At most twice
/// of what it has, so that the next look sees what came of it, and the whole blocks of `most`. Tiles whose noise is not
/// known well learn from their neighbours: half of it is the mean of the nine.
///
/// What a tile gets depends on the samples that it has: a pixel's mean is not free of bias, of at most the covariance
/// of its own noise with its tile's share of samples (docs/adaptive.md measures it).
SamplePlan next_plan(const Film& film, double max_rms, uint64_t most);

}  // namespace frond
