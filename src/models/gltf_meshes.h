#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "imports/node_map.h"
#include "models/gltf_data.h"
#include "models/gltf_materials.h"

namespace frond {

/// Reads the meshes that nodes have, with their materials, into a scene; each once.
class GltfMeshes {
 public:
  using NodeMaps = std::map<uint64_t, NodeMap>;

  GltfMeshes(const nlohmann::json& document, GltfData& data, GltfLosses& losses, ImportedScene& scene)
      : document_(document), data_(data), losses_(losses), scene_(scene), materials_(document, data, losses, scene) {}

  /// Returns the meshes in the scene of a node's mesh `index`, with the weights of its morph targets applied, and
  /// placed in the world by the joints of its skin. `to_world`: of all nodes, which joints are.
  const std::vector<uint32_t>& meshes_of(const nlohmann::json& node, uint64_t index, const NodeMaps& to_world);

 private:
  using Json = nlohmann::json;
  /// Returns the maps of a skin's joints from its vertices to the world.
  std::vector<NodeMap> joints_of(uint64_t index, const NodeMaps& to_world);
  /// Reads the triangles of a primitive. Its attributes are as many as its positions.
  void add_primitive(const Json& primitive, const std::string& place, const std::string& name,
                     const std::vector<double>& weights, const std::vector<NodeMap>& joints, std::vector<uint32_t>& to);
  /// Whether the positions are also there without the extension that compresses them.
  bool has_data(const Json& attributes) const;
  /// Returns an attribute of `count` vertices, or nothing; any number of them if `count` is 0.
  template <size_t width>
  std::vector<std::array<float, width>> vertices(const Json& attributes, const std::string& name,
                                                 const std::string& place, size_t count);
  void apply_colors(const Json& attributes, const std::string& place, ImportedMesh& mesh);
  void add_coordinates(const Json& attributes, const std::string& place, ImportedMesh& mesh);
  /// Adds the displacements of the morph targets.
  void morph(const Json& primitive, const std::string& place, const std::vector<double>& weights, ImportedMesh& mesh);
  /// Moves the vertices to the world by the weighted maps of their joints.
  void place_by_joints(const Json& attributes, const std::string& place, const std::vector<NodeMap>& joints,
                       ImportedMesh& mesh);
  /// Triangles of a list, a strip or a fan.
  std::vector<std::array<uint32_t, 3>> triangles(const Json& primitive, const std::string& place, double mode,
                                                 size_t count);

  const Json& document_;
  GltfData& data_;
  GltfLosses& losses_;
  ImportedScene& scene_;
  GltfMaterials materials_;
  std::map<std::tuple<uint64_t, std::optional<uint64_t>, std::vector<double>>, std::vector<uint32_t>> meshes_;
  std::set<uint64_t> seen_;  ///< meshes whose properties were compared
};

}  // namespace frond
