#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/material.h"
#include "core/plugin.h"
#include "core/ray.h"
#include "core/transform.h"
#include "scene/mesh.h"

namespace frond {

struct Bounds {
  Vec3 min{INFINITY, INFINITY, INFINITY}, max{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vec3& p);
  bool is_empty() const { return !(min.x <= max.x); }
  std::vector<Vec3> corners() const;
};

/// A point of a surface.
struct ShapePoint {
  Vec3 p, ng;   ///< the geometric normal is unit, on the front
  Vec2 at;      ///< where on the primitive that is, by its own parameters
  float t = 0;  ///< along the ray that met it
  unsigned primitive = 0;
};

/// A surface with its own intersection routine, in the space that its transform leads to; one or more primitives.
class AnalyticShape {
 public:
  virtual ~AnalyticShape() = default;
  virtual unsigned count() const { return 1; }
  virtual Bounds bounds(unsigned primitive) const = 0;
  /// Points around a primitive: it lies within their convex hull. The corners of its bounds, or some that lie closer.
  virtual std::vector<Vec3> outline(unsigned primitive) const { return bounds(primitive).corners(); }
  /// The nearest point with t_min < t < ray.t_max.
  virtual std::optional<ShapePoint> intersect(unsigned primitive, const Ray& ray, float t_min) const = 0;
  /// Texture coordinates of a point, by its own parameters.
  virtual Vec2 uv(unsigned /*primitive*/, Vec2 at) const { return at; }
  /// By texture coordinates.
  virtual SurfaceDerivatives derivatives(const ShapePoint& point) const = 0;
  /// Uniform over the area.
  virtual ShapePoint sample(Vec2 u) const = 0;
  virtual double area() const = 0;
  /// Why `sample` would not be uniform over the area here; empty where it is.
  virtual std::string_view cannot_emit() const { return {}; }
};

using MeshPtr = std::shared_ptr<const TriangleMesh>;
using AnalyticShapePtr = std::shared_ptr<const AnalyticShape>;

/// A surface: triangles for Embree's own routines, or one with its own.
using ShapeGeometry = std::variant<MeshPtr, AnalyticShapePtr>;

/// Copies of an object of the scene.
struct ObjectCopies {
  std::string object;
  std::filesystem::path table;  ///< of an InstanceTable
};

/// What a shape plugin makes.
using MadeShape = std::variant<ShapeGeometry, ObjectCopies>;

struct ShapePlacement {
  Transform to_scene;        ///< from the shape's space to that of the scene, or of the object it is defined in
  bool reverse_orientation;  ///< of the directive: front and back swapped
};

struct ShapeInfo : PluginInfo {
  MadeShape (*make)(const Params&, const ShapePlacement&);
};

/// The parameter that every shape has besides its own.
inline constexpr Param kAlphaParam{.name = "alpha",
                                   .kind = ParamKind::float_texture,
                                   .default_value = 1.0,
                                   .range = {0, 1},
                                   .doc = "Opacity: the chance that a ray meets the surface."};

}  // namespace frond
