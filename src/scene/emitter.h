#pragma once

#include <optional>

#include "core/light.h"
#include "core/texture.h"
#include "scene/distribution.h"
#include "scene/geometry.h"

namespace frond {

/// Points over the area of a shape that gives off light, triangles included.
class EmittingSurface {
 public:
  /// `surface` in world space. With a primitive it is that one alone.
  explicit EmittingSurface(const Surface& surface, std::optional<unsigned> primitive = {});

  struct Sample {
    ShapePoint point;
    Vec2 uv;
    float weight;  ///< 1 / area over the density: 1 where points are evenly spread over the area
  };
  Sample sample(Vec2 u) const;
  double area() const { return area_; }
  LightBounds bounds() const;

  /// Whether rays can meet it. With an alpha of 0 they never do: all of its light comes from samples, as in pbrt-v4.
  bool is_met() const { return is_met_; }
  /// Share of the light that alpha leaves of what is met or sampled there.
  float opacity(Vec2 uv) const { return alpha_ ? alpha_->evaluate({uv, {}}) : 1; }

 private:
  unsigned count() const;
  double area_of(unsigned primitive) const;
  /// Uniform numbers in, a point out; its area is set.
  ShapePoint sample(unsigned primitive, Vec2 u) const;

  ShapeGeometry geometry_;
  std::shared_ptr<const FloatTexture> alpha_;  ///< null: opaque, or never met
  bool is_met_ = true;
  std::optional<unsigned> only_;
  std::optional<Distribution1D> by_area_;  ///< of all primitives
  double area_ = 0;
};

/// How many triangles, patches or the like it has.
unsigned primitives_of(const ShapeGeometry& geometry);

}  // namespace frond
