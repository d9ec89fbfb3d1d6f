#pragma once

#include <optional>

#include "core/light.h"
#include "scene/distribution.h"
#include "scene/shape.h"

namespace frond {

/// Uniform points over the area of a shape, triangles included.
class EmittingSurface {
 public:
  /// `geometry` in world space.
  explicit EmittingSurface(const ShapeGeometry& geometry);
  ShapePoint sample(Vec2 u) const;
  Vec2 uv(const ShapePoint& point) const;
  double area() const { return area_; }
  LightBounds bounds() const;

 private:
  ShapeGeometry geometry_;
  std::optional<Distribution1D> triangles_by_area_;
  double area_;
};

}  // namespace frond
