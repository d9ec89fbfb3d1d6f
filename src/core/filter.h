#pragma once

#include <optional>

#include "core/math/vec.h"
#include "core/plugin.h"

namespace frond {

/// How pixel values are reconstructed from samples.
enum class Reconstruction : uint8_t {
  importance,  ///< the filter is importance-sampled (filter importance sampling); a sample counts in one pixel
  splatting    ///< samples are uniform in the pixel; a sample counts in all pixels within the filter's radius
};

/// Pixel filter, as pbrt's Filter. Thread-safe.
class Filter {
 public:
  /// Position and weight of an importance sample of the filter.
  struct Sample {
    Vec2 offset;   ///< pixels from the pixel's centre
    float weight;  ///< filter / density, mean 1; negative in the negative lobes of a filter that has some
  };
  virtual ~Filter() = default;
  /// Returns the importance sample for a uniform `u` in [0, 1)^2.
  virtual Sample sample(Vec2 u) const = 0;
  /// True if all samples lie inside the pixel (radius of at most 0.5).
  virtual bool stays_in_pixel() const { return false; }

  /// Radius in x and y of a separable filter, in pixels; 0 if the filter is not separable, and then it is always
  /// importance-sampled.
  virtual Vec2 radius() const { return {}; }
  /// The two factors of a separable filter, f_x(offset.x) and f_y(offset.y), up to a constant; `offset` is from the
  /// pixel's centre, in pixels. They are 0 beyond the radius.
  virtual Vec2 evaluate_axes(Vec2 /*offset*/) const { return {}; }
  /// Reconstruction that the scene file states; if it is empty, the renderer selects the one with less noise.
  virtual std::optional<Reconstruction> reconstruction() const { return {}; }
};

/// Plug-in record of a filter.
struct FilterInfo : PluginInfo {
  /// Returns a filter, not null. Throws InputError.
  std::unique_ptr<Filter> (*make)(const Params&);
};

}  // namespace frond
