#pragma once

#include <optional>

#include "core/plugin.h"
#include "core/vec.h"

namespace frond {

/// How pixels are made of samples that a filter weighs.
enum class Reconstruction : uint8_t {
  importance,  ///< a pixel's samples lie where its filter is, and no other pixel has them
  splatting    ///< a pixel's samples lie in it, and every pixel within the filter's reach has them, by their weights
};

/// Pixel filter.
class Filter {
 public:
  /// Importance sampling: where in the plane a pixel's sample falls, and its weight.
  struct Sample {
    Vec2 offset;   ///< pixels from the pixel's centre
    float weight;  ///< filter / density, mean 1; negative in the negative lobes of a filter that has some
  };
  virtual ~Filter() = default;
  virtual Sample sample(Vec2 u) const = 0;
  /// Whether all samples fall into the pixel itself.
  virtual bool stays_in_pixel() const { return false; }

  /// Of a filter that is the product of a function along x and one along y: half its width and height, pixels. 0 where
  /// it is none: it is always importance-sampled.
  virtual Vec2 radius() const { return {}; }
  /// These functions at offsets from the pixel's centre, pixels, in any unit; 0 beyond the radius.
  virtual Vec2 along(Vec2 /*offset*/) const { return {}; }
  /// What the scene says; nothing: what makes less noise.
  virtual std::optional<Reconstruction> reconstruction() const { return {}; }
};

struct FilterInfo : PluginInfo {
  std::unique_ptr<Filter> (*make)(const Params&);
};

}  // namespace frond
