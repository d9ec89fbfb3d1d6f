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
#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/plugin.h"

namespace frond {

/// Triangle mesh with shared vertices, in scene space. Every index is below p.size(); `n` and `uv` are empty or as long
/// as `p`. Seen from the front, triangles are counter-clockwise; `orient_mesh` ensures this.
struct TriangleMesh {
  std::vector<Vec3> p;                             ///< vertices
  std::vector<Vec3> n;                             ///< shading normals, any length
  std::vector<Vec2> uv;                            ///< texture coordinates
  std::vector<std::array<uint32_t, 3>> triangles;  ///< indices of vertices
  /// For each triangle, whether orient_mesh exchanged its second and third vertex. It is empty if no triangle was
  /// exchanged or if the mesh has texture coordinates.
  std::vector<bool> flipped = {};
  /// Triangles from this index on are halves of quadrilaterals, in pairs: vertices 0 1 2 and 0 2 3.
  size_t halves_from = SIZE_MAX;
};

/// Axis-aligned bounding box; empty by default.
struct Bounds {
  Vec3 min{INFINITY, INFINITY, INFINITY}, max{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vec3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  bool is_empty() const { return !(min.x <= max.x); }
  /// Its eight corners; none if the box is empty.
  std::vector<Vec3> corners() const {
    std::vector<Vec3> points;
    if (is_empty()) return points;
    for (const float x : {min.x, max.x})
      for (const float y : {min.y, max.y})
        for (const float z : {min.z, max.z}) points.push_back({x, y, z});
    return points;
  }
};

/// Point of a surface.
struct ShapePoint {
  Vec3 p, ng;              ///< position, and geometric normal, unit, on the front
  Vec2 at;                 ///< surface parameters of the point, as the shape defines them
  float t = 0;             ///< ray parameter of an intersection
  unsigned primitive = 0;  ///< index of the primitive
  double area = 0;         ///< of a sampled point: 1 / (its density per area)
};

/// Surface with an intersection routine in C++: one or more primitives, in the space to which ShapePlacement::to_scene
/// maps. Thread-safe.
class AnalyticShape {
 public:
  virtual ~AnalyticShape() = default;
  /// Number of primitives.
  virtual unsigned count() const { return 1; }
  /// Bounding box of a primitive.
  virtual Bounds bounds(unsigned primitive) const = 0;
  /// Points whose convex hull contains the primitive: the corners of its bounds, or closer points.
  virtual std::vector<Vec3> outline(unsigned primitive) const { return bounds(primitive).corners(); }
  /// Nearest intersection with t_min < t < ray.t_max; empty if there is none.
  virtual std::optional<ShapePoint> intersect(unsigned primitive, const Ray& ray, float t_min) const = 0;
  /// Texture coordinates at the surface parameters `at`.
  virtual Vec2 uv(unsigned /*primitive*/, Vec2 at) const { return at; }
  /// Derivatives with respect to the texture coordinates.
  virtual SurfaceDerivatives derivatives(const ShapePoint& point) const = 0;
  /// True if the shape has neither shading normals nor a clearance; then the next two functions are not called.
  bool is_plain() const { return is_plain_; }
  /// Shading normal, of any length; 0 if it is the geometric normal.
  virtual Vec3 shading_normal(unsigned /*primitive*/, Vec2 /*at*/) const { return {}; }
  /// Distance along the normal from the point to the origin of rays that leave it, if rounding errors need less.
  virtual float clearance(const ShapePoint& /*point*/) const { return 0; }
  /// Samples a point of the primitive, nearly uniformly over its area, for `u` in [0, 1)^2; sets the point's `area`.
  virtual ShapePoint sample(unsigned primitive, Vec2 u) const = 0;
  /// Area of one side of a primitive.
  virtual double area(unsigned primitive) const = 0;
  /// Reason why the shape cannot be sampled as a light; empty if it can.
  virtual std::string_view cannot_emit() const { return {}; }

 protected:
  explicit AnalyticShape(bool is_plain = true) : is_plain_(is_plain) {}

 private:
  bool is_plain_;
};

using MeshPtr = std::shared_ptr<const TriangleMesh>;
using AnalyticShapePtr = std::shared_ptr<const AnalyticShape>;

/// A surface: triangles, which Embree intersects, or an analytic shape.
using ShapeGeometry = std::variant<MeshPtr, AnalyticShapePtr>;

/// Instances of an object of the scene, placed by a table.
struct ObjectInstances {
  std::string object;           ///< name of the object
  std::filesystem::path table;  ///< file of an InstanceTable
};

/// Result of a shape plug-in: one or more surfaces, or instances of an object.
using MadeShape = std::variant<std::vector<ShapeGeometry>, ObjectInstances>;

/// Placement of a shape by its directive.
struct ShapePlacement {
  Transform to_scene;        ///< from the shape's space to the space of the scene, or of the object that contains it
  bool reverse_orientation;  ///< ReverseOrientation: front and back are exchanged
};

/// Transforms a mesh's normals to scene space, normalizes them and flips them if ReverseOrientation is set.
inline void place_normals(std::vector<Vec3>& normals, const ShapePlacement& placement) {
  for (Vec3& n : normals) {
    const Vec3 m = normalize_any(placement.to_scene.normal(normalize_any(n)));
    n = placement.reverse_orientation ? -m : m;
  }
}

/// Reorders the vertices of triangles so that they are counter-clockwise seen from the front. As in pbrt, the front is
/// the side of the vertex normals; without them, or if they are 0 or lie in the plane of the triangle, it follows from
/// the order of vertices, the handedness of the transformation and ReverseOrientation. Positions and normals must be in
/// scene space.
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
    mesh.flipped.resize(mesh.triangles.size());
    mesh.flipped[i] = true;
  }
}

/// Plug-in record of a shape. `make` throws InputError.
struct ShapeInfo : PluginInfo {
  MadeShape (*make)(const Params&, const ShapePlacement&);
};

/// Parameter that a shape adds to its own if it can be partly transparent; the renderer reads it. All built-in shapes
/// have it.
inline constexpr Param kAlphaParam{.name = "alpha",
                                   .kind = ParamKind::float_texture,
                                   .default_value = 1.0,
                                   .range = {0, 1},
                                   .doc = "Opacity: the chance that a ray meets the surface."};

}  // namespace frond
