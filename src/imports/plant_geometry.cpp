#include "imports/plant_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "core/error.h"

namespace frond {
namespace {

/// Adds a mesh under a map. A mirroring map keeps the front of a surface where it is in the mesh, as glTF and pbrt
/// define: the order of the vertices is reversed.
void append(PlantMesh& to, const ImportedMesh& mesh, const NodeMap& map) {
  const auto first = uint32_t(to.p.size());
  for (const auto& p : mesh.positions) to.p.push_back(to_float(map.point(to_double(p))));
  for (const auto& n : mesh.normals) {
    const Vec3d normal = map.normal(to_double(n));
    const double size = length(normal);
    to.n.push_back(size > 0 ? to_float(normal / size) : Vec3{0, 0, 1});
  }
  for (const auto& uv : mesh.uvs) to.uv.push_back({uv[0], uv[1]});
  const bool is_mirrored = map.determinant() < 0;
  for (auto t : mesh.triangles) {
    if (is_mirrored) std::swap(t[1], t[2]);
    to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

/// Whether there is no inverse in single precision.
bool is_flat(const NodeMap& map) {
  const double size = length(map.vector({1, 0, 0})) * length(map.vector({0, 1, 0})) * length(map.vector({0, 0, 1}));
  return !(std::abs(map.determinant()) > 1e-9 * size) || !std::isfinite(size) || !problem_of(affine_map(map)).empty();
}

/// Extends the bounds of `geometry` by the meshes under a map.
void extend(PlantGeometry& geometry, const std::vector<PlantMesh>& meshes, const NodeMap& map) {
  constexpr double kLargest = 1e17;  // of coordinates that shapes may have, and some room for the camera
  for (const PlantMesh& mesh : meshes)
    for (const Vec3& p : mesh.p) {
      const Vec3d q = map.point(to_double(p));
      if (!(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) < kLargest))
        fail({}, "the model has a vertex at {} {} {}, beyond {}: it needs a smaller scale", q.x, q.y, q.z, kLargest);
      geometry.least = {std::min(geometry.least.x, q.x), std::min(geometry.least.y, q.y),
                        std::min(geometry.least.z, q.z)};
      geometry.most = {std::max(geometry.most.x, q.x), std::max(geometry.most.y, q.y), std::max(geometry.most.z, q.z)};
    }
}

/// Extends the bounds by an object's bounding box under each of its maps: all vertices under all maps could be many.
void extend(PlantGeometry& geometry, const PlantObject& object) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PlantGeometry own{.least = {kInfinity, kInfinity, kInfinity}, .most = {-kInfinity, -kInfinity, -kInfinity}};
  extend(own, object.meshes, {});
  PlantMesh box;
  for (int corner = 0; corner < 8; ++corner)
    box.p.push_back(to_float({corner & 1 ? own.most.x : own.least.x, corner & 2 ? own.most.y : own.least.y,
                              corner & 4 ? own.most.z : own.least.z}));
  for (const NodeMap& map : object.instances) extend(geometry, {box}, map);
}

/// Nodes by the meshes that they have.
using Uses = std::map<std::vector<uint32_t>, std::vector<size_t>>;

/// Object of meshes that several nodes have.
PlantObject object_of(const ImportedScene& scene, const std::vector<uint32_t>& meshes, const std::string& name) {
  PlantObject object{.name = name};
  for (const uint32_t m : meshes) {
    const ImportedMesh& mesh = scene.meshes[m];
    PlantMesh own{{}, name + "-" + scene.materials[mesh.material].name, mesh.material};
    append(own, mesh, {});
    if (!has_normals(mesh)) own.n.clear();
    object.meshes.push_back(std::move(own));
  }
  return object;
}

}  // namespace

/// Normals of vertices whose face has no area may be 0, which has no direction: the mesh is then written without.
bool has_normals(const ImportedMesh& mesh) {
  return !mesh.normals.empty() && std::ranges::none_of(mesh.normals, [](const auto& n) {
    return !(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]) > 0) || !std::isfinite(n[0] + n[1] + n[2]);
  });
}

AffineMap affine_map(const NodeMap& map) {
  AffineMap result;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) result.rows[i][j] = float(map.m[4 * i + j]);
  return result;
}

size_t PlantGeometry::triangle_count() const {
  size_t count = 0;
  for (const PlantMesh& m : meshes) count += m.triangles.size();
  for (const PlantObject& o : objects)
    for (const PlantMesh& m : o.meshes) count += m.triangles.size();
  return count;
}

size_t PlantGeometry::instance_count() const {
  size_t count = 0;
  for (const PlantObject& o : objects) count += o.instances.size();
  return count;
}

/// Single meshes are joined by material: a model with a group for each leaf would else be thousands of files.
PlantGeometry plant_geometry(const ImportedScene& scene, const NodeMap& to_world, bool keeps_objects) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PlantGeometry geometry{.least = {kInfinity, kInfinity, kInfinity}, .most = {-kInfinity, -kInfinity, -kInfinity}};
  geometry.origin = to_world.vector({scene.origin[0], scene.origin[1], scene.origin[2]});
  std::vector<NodeMap> maps;
  Uses uses;
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const ImportedNode& node = scene.nodes[i];
    maps.push_back((node.parent < 0 ? to_world : maps[size_t(node.parent)]).after({node.to_parent}));
    if (node.meshes.empty()) continue;
    if (is_flat(maps.back()))
      ++geometry.flat_nodes;
    else
      uses[node.meshes].push_back(i);
  }
  using Key = std::tuple<uint32_t, bool, bool>;  // material, with normals, with texture coordinates
  std::map<Key, PlantMesh> joined;
  constexpr size_t kMostEmitting = 1'000'000;  // triangles of instances that emit; objects cannot emit
  for (const auto& [meshes, nodes] : uses) {
    size_t triangles = 0;
    bool is_emitter = false;
    for (const uint32_t m : meshes) {
      triangles += scene.meshes[m].triangles.size();
      is_emitter = is_emitter || scene.materials[scene.meshes[m].material].is_emitter();
    }
    if ((nodes.size() > 1 || keeps_objects) && !(is_emitter && triangles <= kMostEmitting / nodes.size())) {
      const std::string &of_mesh = scene.meshes[meshes.front()].name, &of_node = scene.nodes[nodes.front()].name;
      geometry.objects.push_back(object_of(scene, meshes, nodes.size() > 1 || of_node.empty() ? of_mesh : of_node));
      for (const size_t i : nodes) geometry.objects.back().instances.push_back(maps[i]);
      continue;
    }
    for (const uint32_t m : meshes) {
      const ImportedMesh& mesh = scene.meshes[m];
      PlantMesh& to = joined[{mesh.material, has_normals(mesh), !mesh.uvs.empty()}];
      to.name = scene.materials[mesh.material].name;
      to.material = mesh.material;
      for (const size_t i : nodes) append(to, mesh, maps[i]);
      if (!has_normals(mesh)) to.n.clear();
    }
  }
  for (auto& [key, mesh] : joined) geometry.meshes.push_back(std::move(mesh));
  extend(geometry, geometry.meshes, {});
  for (const PlantObject& object : geometry.objects) extend(geometry, object);
  if (geometry.triangle_count() == 0 || !(geometry.least.x <= geometry.most.x))
    fail({}, "the model has no node with triangles");
  return geometry;
}

}  // namespace frond
