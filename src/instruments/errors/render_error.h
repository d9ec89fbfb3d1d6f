#pragma once

#include "instruments/errors/image_error.h"

namespace frond {

/// Two independent renders of one image in one channel, pixel by pixel.
struct RenderPair {
  std::span<const float> first, second;
};

/// How far a render is from what the reference's method would converge to. The reference is noisy itself: what its two
/// halves say of that is taken out. Standard errors are never too small: a mean square's variance is bounded by the sum
/// of the pixels' squares, since their expectations differ and each is seen once.
struct RenderError {
  MeanSquare total;            ///< of one render: bias and noise
  MeanSquare clipped;          ///< the same after clipping every image to [0, 1]
  MeanSquare noise;            ///< of one render, from how the two differ
  MeanSquare bias;             ///< what no number of samples takes away
  MeanSquare reference_noise;  ///< of the mean of the reference's two; not in the above

  RenderError& operator+=(const RenderError& other);
};

/// `renders` are two of as many samples each, of which one is judged. `use` (as long as the channel, or empty for all
/// pixels) picks pixels by a weight above 0.5. No pixels: all 0.
RenderError render_error(const RenderPair& renders, const RenderPair& reference, std::span<const float> use = {});

/// The mean of both renders over the pixels that `use` picks as above. No pixels: 0.
double mean_of(const RenderPair& renders, std::span<const float> use = {});

/// In units of `unit` (above 0): mean squares over its square, so that roots are over it.
RenderError in_units_of(double unit, RenderError error);

/// Of several channels together, each with the same weight. Their errors may hang together in any way.
RenderError mean_of(std::span<const RenderError> channels);

/// Of the same thing measured several times, renders and reference anew each time.
RenderError mean_of_independent(std::span<const RenderError> repeats);

}  // namespace frond
