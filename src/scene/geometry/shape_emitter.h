#pragma once

#include <optional>

#include "core/light.h"
#include "core/math/distribution.h"
#include "core/texture.h"
#include "scene/geometry/geometry.h"

namespace frond {

/// Range of a surface's primitives; `end` is excluded.
struct Primitives {
  unsigned first, end;
  unsigned count() const { return end - first; }
};

/// Returns the primitives of one face of the shape's file; a quadrilateral that was split has two.
Primitives face_of(const ShapeGeometry& geometry, unsigned primitive);
/// Returns the number of faces in the shape's file.
unsigned faces_of(const ShapeGeometry& geometry);

/// The emitting part of a shape: all of it, or a range of its primitives.
class ShapeEmitter final : public EmittingSurface {
 public:
  explicit ShapeEmitter(const Surface& surface);
  ShapeEmitter(const Surface& surface, Primitives primitives);

  Sample sample(Vec2 u) const override;
  double area() const override { return area_; }
  LightBounds bounds() const override;
  bool is_intersectable() const override { return is_intersectable_; }
  /// Returns the alpha at a point; 1 without alpha texture.
  float opacity(const EmittingPoint& at) const override {
    return alpha_ ? alpha_->evaluate({.uv = at.uv, .p = at.p, .n = at.ng}) : 1;
  }

 private:
  double area_of(unsigned i) const;
  /// Returns a point for uniform numbers; sets its area.
  ShapePoint sample(unsigned primitive, Vec2 u) const;

  ShapeGeometry geometry_;
  std::shared_ptr<const FloatTexture> alpha_;  ///< nullptr: opaque
  bool is_intersectable_ = true;
  Primitives primitives_;
  std::optional<Distribution1D> by_area_;  ///< empty for a single primitive
  double area_ = 0;
};

/// Returns the number of triangles, patches or other primitives.
unsigned primitives_of(const ShapeGeometry& geometry);

}  // namespace frond
