#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/math/affine_map.h"
#include "core/math/vec.h"
#include "core/shape.h"
#include "imports/imported_scene.h"
#include "imports/node_map.h"

namespace frond {

/// Whether all normals of a mesh have a direction.
bool has_normals(const ImportedMesh& mesh);

/// Returns the map in single precision.
AffineMap affine_map(const NodeMap& map);

/// Triangles of one material, in the space of an object or of the world.
struct PlantMesh : TriangleMesh {
  std::string name = {};  ///< of the material, or of an object and its material
  uint32_t material = 0;
};

/// Meshes that several nodes have, and where.
struct PlantObject {
  std::string name;
  std::vector<PlantMesh> meshes = {};
  std::vector<NodeMap> instances = {};
};

/// Geometry of a model in the space of the scene to write: z is up.
struct PlantGeometry {
  std::vector<PlantMesh> meshes = {};  ///< of nodes whose meshes no other node has, joined by material, in world space
  std::vector<PlantObject> objects = {};
  size_t flat_nodes = 0;  ///< nodes that are left out, because their transform has no inverse
  Vec3d least{}, most{};  ///< bounds
  Vec3d origin{};         ///< of the scene to write: everything is relative to it

  size_t triangle_count() const;  ///< each mesh of an object once
  size_t instance_count() const;
};

/// Returns the geometry of all nodes under `to_world`. With `keeps_objects` no meshes are joined: the meshes of each
/// node are an object with the node's name. Throws InputError if there is none, or if coordinates are beyond what frond
/// renders.
PlantGeometry plant_geometry(const ImportedScene& scene, const NodeMap& to_world, bool keeps_objects = false);

}  // namespace frond
