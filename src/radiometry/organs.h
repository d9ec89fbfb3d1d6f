#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/geometry/surface_points.h"
#include "scene/scene.h"

namespace frond {

/// Division of a scene's surfaces into organs, each of which is measured.
enum class OrganKind : uint8_t {
  instance,  ///< all surfaces of an instance of an object; surfaces that are not instanced belong to no organ
  mesh,      ///< a surface, in each of its instances
  part,      ///< the triangles of a mesh that are connected by vertices of equal position
  triangle,  ///< a triangle, or a primitive of another shape
  material,  ///< all surfaces of a material
};

/// Names of the kinds, in their order, and of several organs.
inline constexpr std::string_view kOrganKinds[] = {"instance", "mesh", "part", "triangle", "material"};
inline constexpr std::string_view kOrganPlurals[] = {"instances", "meshes", "parts", "triangles", "materials"};

/// The organs of a scene, numbered from 1 in the order of the scene file.
class Organs {
 public:
  /// `material_names`: by index in the description. Throws InputError if the scene has no instances, for
  /// OrganKind::instance.
  Organs(const Scene& scene, std::vector<std::string> material_names, OrganKind kind);

  OrganKind kind() const { return kind_; }
  /// Returns the number of organs.
  uint64_t size() const { return areas_.size(); }
  /// Returns the number of the organ of a hit; 0: the surface belongs to no organ.
  uint64_t number(const GeometryHit& met) const {
    if (kind_ == OrganKind::instance) return met.instance;
    if (kind_ == OrganKind::material) return met.material + 1;
    return number(*met.shape, met.instance, met.primitive);
  }

  /// One-sided areas by number minus 1, in scene units squared. 0: the organ has no surface, as an unused material.
  const std::vector<float>& areas() const { return areas_; }
  /// Means of position over the area, in the coordinates of the scene file.
  const std::vector<Vec3d>& centers() const { return centers_; }
  /// Returns the number of the instance of an object that the organ belongs to; 0: none.
  uint64_t instance(uint64_t number) const { return instances_.empty() ? 0 : instances_[number - 1]; }
  /// Returns the name of the organ's object, or without an object that of its material.
  std::string_view name(uint64_t number) const;
  /// Returns the name of the organ's material; "" if it has several.
  std::string_view material(uint64_t number) const;

  /// Calls visit(corners, number) for the triangles of all meshes, in the coordinates of the scene file. Returns the
  /// number of surfaces that are no meshes.
  size_t visit_triangles(const std::function<void(const std::array<Vec3d, 3>& corners, uint64_t number)>& visit) const;

  /// Draws `points` points of each organ, or one more or less, uniformly over its area, one in each of as many equal
  /// areas; calls visit(point, number). The points depend on `key` alone.
  void draw(size_t points, uint64_t key,
            const std::function<void(const RandomSurfacePoint& point, uint64_t number)>& visit) const;

 private:
  /// Place of a surface among the organs of its object.
  struct Place {
    uint64_t first = 0;                ///< number of the preceding organs
    std::vector<uint32_t> parts = {};  ///< part by triangle; empty: one part
    uint64_t count = 1;                ///< number of organs of the surface
  };
  uint64_t number(const Surface& surface, uint64_t instance, uint32_t primitive) const;
  void add_place(const Surface& surface, uint64_t first);
  /// Calls visit(surface, map, instance, primitive, number, area and centre) for each primitive of an organ.
  template <class Visit>
  void visit_primitives(const Visit& visit) const;

  const Scene& scene_;
  std::vector<std::string> material_names_;
  OrganKind kind_;
  std::unordered_map<const Surface*, Place> places_;  ///< kinds mesh, part and triangle
  std::vector<uint64_t> first_;                       ///< by instance: number of the organs before it
  std::vector<float> areas_;
  std::vector<Vec3d> centers_;
  std::vector<uint64_t> instances_;
  std::vector<uint32_t> materials_;  ///< index in the description; kSeveral
  std::vector<std::pair<uint64_t, std::string>> object_names_;
  static constexpr uint32_t kSeveral = ~0u;
};

}  // namespace frond
