#pragma once

#include "core/plugin.h"
#include "core/vec.h"

namespace frond {

/// Pixel filter, used by importance sampling: where in the plane a pixel's sample falls, and its weight.
class Filter {
 public:
  struct Sample {
    Vec2 offset;   ///< pixels from the pixel's centre
    float weight;  ///< filter / density, mean 1; negative in the negative lobes of a filter that has some
  };
  virtual ~Filter() = default;
  virtual Sample sample(Vec2 u) const = 0;
  /// Whether all samples fall into the pixel itself.
  virtual bool stays_in_pixel() const { return false; }
};

struct FilterInfo : PluginInfo {
  std::unique_ptr<Filter> (*make)(const Params&);
};

}  // namespace frond
