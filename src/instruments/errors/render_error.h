#pragma once

#include "instruments/errors/image_error.h"

namespace frond {

/// Two independent renders of one image in one channel, by pixel.
struct RenderPair {
  std::span<const float> first, second;
};

/// Error of a render against the image that the reference's method converges to. The reference's own noise is estimated
/// from its two halves and subtracted. Standard errors are upper bounds: a mean square's variance is bounded by the sum
/// of the pixels' squares, since their expectations differ and each is seen once.
struct RenderError {
  MeanSquare total;            ///< of one render: bias and noise
  MeanSquare clipped;          ///< the same after clipping every image to [0, 1]
  MeanSquare noise;            ///< of one render, from the difference of the two
  MeanSquare bias;             ///< error that no number of samples removes
  MeanSquare reference_noise;  ///< of the mean of the reference's two halves; not included above

  RenderError& operator+=(const RenderError& other);
};

/// Computes the error. `renders`: two renders with equally many samples, of which one is judged. `use` (as long as the
/// channel, or empty for all pixels) selects pixels by a weight above 0.5. No pixels: all 0.
RenderError render_error(const RenderPair& renders, const RenderPair& reference, std::span<const float> use = {});

/// Mean of both renders over the pixels that `use` selects as above. No pixels: 0.
double mean_of(const RenderPair& renders, std::span<const float> use = {});

/// Returns the error in units of `unit` > 0: mean squares are divided by its square.
RenderError in_unit(double unit, RenderError error);

/// Mean over several channels of equal weight, whose errors may be correlated in any way.
RenderError mean_of(std::span<const RenderError> channels);

/// Mean over independent repetitions of one measurement, with new renders and a new reference each time.
RenderError mean_of_independent(std::span<const RenderError> repeats);

}  // namespace frond
