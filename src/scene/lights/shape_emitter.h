#pragma once

#include <optional>

#include "core/light.h"
#include "core/texture.h"
#include "scene/geometry/geometry.h"
#include "scene/math/distribution.h"

namespace frond {

/// Of a surface's triangles, patches or the like these; the end is not among them.
struct Primitives {
  unsigned first, end;
  unsigned count() const { return end - first; }
};

/// Those of the triangle, patch or the like that a shape's file has there: of a quadrilateral that was cut the halves.
Primitives face_of(const ShapeGeometry& geometry, unsigned primitive);
/// How many triangles, patches or the like a shape's file has.
unsigned faces_of(const ShapeGeometry& geometry);

/// All of a shape, or some of its primitives, triangles included.
class ShapeEmitter final : public EmittingSurface {
 public:
  explicit ShapeEmitter(const Surface& surface);
  ShapeEmitter(const Surface& surface, Primitives primitives);

  Sample sample(Vec2 u) const override;
  double area() const override { return area_; }
  LightBounds bounds() const override;
  bool is_met() const override { return is_met_; }
  float opacity(const EmittingPoint& at) const override {
    return alpha_ ? alpha_->evaluate({.uv = at.uv, .p = at.p, .n = at.ng}) : 1;
  }

 private:
  double area_of(unsigned primitive) const;
  /// Uniform numbers in, a point out; its area is set.
  ShapePoint sample(unsigned primitive, Vec2 u) const;

  ShapeGeometry geometry_;
  std::shared_ptr<const FloatTexture> alpha_;  ///< null: opaque, or never met
  bool is_met_ = true;
  Primitives primitives_;
  std::optional<Distribution1D> by_area_;  ///< of several primitives
  double area_ = 0;
};

/// How many triangles, patches or the like it has.
unsigned primitives_of(const ShapeGeometry& geometry);

}  // namespace frond
