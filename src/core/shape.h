#pragma once

#include <algorithm>
#include <array>
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

namespace frond {

/// Triangles over shared vertices, in the scene's space. Every index is below p.size(); `n` and `uv` are empty or as
/// long as `p`. Triangles wind counter-clockwise about the front: `orient_mesh` turns them so.
struct TriangleMesh {
  std::vector<Vec3> p;   ///< vertices
  std::vector<Vec3> n;   ///< shading normals, any length
  std::vector<Vec2> uv;  ///< texture coordinates
  std::vector<std::array<uint32_t, 3>> triangles;
  /// Triangles whose second and third corners have changed places, so that they wind about the front; empty: none, or
  /// it does not matter, as there are texture coordinates.
  std::vector<bool> turned = {};
  /// From this triangle on they are halves of quadrilaterals, two by two: corners 0 1 2 and 0 2 3.
  size_t halves_from = SIZE_MAX;
};

struct Bounds {
  Vec3 min{INFINITY, INFINITY, INFINITY}, max{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vec3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  bool is_empty() const { return !(min.x <= max.x); }
  /// Eight points, or none where it is empty.
  std::vector<Vec3> corners() const {
    std::vector<Vec3> points;
    if (is_empty()) return points;
    for (const float x : {min.x, max.x})
      for (const float y : {min.y, max.y})
        for (const float z : {min.z, max.z}) points.push_back({x, y, z});
    return points;
  }
};

/// A point of a surface.
struct ShapePoint {
  Vec3 p, ng;   ///< the geometric normal is unit, on the front
  Vec2 at;      ///< where on the primitive that is, by its own parameters
  float t = 0;  ///< along the ray that met it
  unsigned primitive = 0;
  double area = 0;  ///< of a sampled point: what it stands for, the reciprocal of its density over the area
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
  /// Shaded with the geometric normal, and left by rays from where they met it: the next two are not asked for.
  bool is_plain() const { return is_plain_; }
  /// Shading normal, of any length; 0: it is the geometric one.
  virtual Vec3 shading_normal(unsigned /*primitive*/, Vec2 /*at*/) const { return {}; }
  /// How far off along the normal rays start that leave it, if that is farther than rounding asks for.
  virtual float clearance(const ShapePoint& /*point*/) const { return 0; }
  /// A point of the primitive, nearly evenly over its area: the point's `area` says how nearly.
  virtual ShapePoint sample(unsigned primitive, Vec2 u) const = 0;
  virtual double area(unsigned primitive) const = 0;
  /// Why it cannot be sampled; empty where it can.
  virtual std::string_view cannot_emit() const { return {}; }

 protected:
  explicit AnalyticShape(bool is_plain = true) : is_plain_(is_plain) {}

 private:
  bool is_plain_;
};

using MeshPtr = std::shared_ptr<const TriangleMesh>;
using AnalyticShapePtr = std::shared_ptr<const AnalyticShape>;

/// A surface: triangles for Embree's own routines, or one with its own.
using ShapeGeometry = std::variant<MeshPtr, AnalyticShapePtr>;

/// Instances of an object of the scene.
struct ObjectInstances {
  std::string object;
  std::filesystem::path table;  ///< of an InstanceTable
};

/// What a shape plugin makes: a surface, or several.
using MadeShape = std::variant<std::vector<ShapeGeometry>, ObjectInstances>;

struct ShapePlacement {
  Transform to_scene;        ///< from the shape's space to that of the scene, or of the object it is defined in
  bool reverse_orientation;  ///< of the directive: front and back swapped
};

/// A mesh's normals into the scene's space, unit, on the side that ReverseOrientation makes the front.
inline void place_normals(std::vector<Vec3>& normals, const ShapePlacement& placement) {
  for (Vec3& n : normals) {
    const Vec3 m = normalize_any(placement.to_scene.normal(normalize_any(n)));
    n = placement.reverse_orientation ? -m : m;
  }
}

/// Turns triangles so that they wind counter-clockwise about the front, which is what decides the side of a surface. As
/// in pbrt: the normals say which side that is where a mesh has them, winding and handedness where not, or where they
/// are 0 or lie in the face. Positions and normals are in the scene's space already.
inline void orient_mesh(TriangleMesh& mesh, const ShapePlacement& placement) {
  const bool flip_winding = placement.reverse_orientation != placement.to_scene.swaps_handedness();
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto& t = mesh.triangles[i];
    const Vec3 n = mesh.n.empty() ? Vec3{} : mesh.n[t[0]] + mesh.n[t[1]] + mesh.n[t[2]];
    const Vec3 face = cross(mesh.p[t[1]] - mesh.p[t[0]], mesh.p[t[2]] - mesh.p[t[0]]);
    const float agreement = dot(normalize_any(face), n);
    if (!(agreement == 0 ? flip_winding : agreement < 0)) continue;
    std::swap(t[1], t[2]);
    if (!mesh.uv.empty()) continue;
    mesh.turned.resize(mesh.triangles.size());
    mesh.turned[i] = true;
  }
}

struct ShapeInfo : PluginInfo {
  MadeShape (*make)(const Params&, const ShapePlacement&);
};

/// Declared beside its own by a shape that can be partly transparent, as all of frond's are; the renderer reads it.
inline constexpr Param kAlphaParam{.name = "alpha",
                                   .kind = ParamKind::float_texture,
                                   .default_value = 1.0,
                                   .range = {0, 1},
                                   .doc = "Opacity: the chance that a ray meets the surface."};

}  // namespace frond
