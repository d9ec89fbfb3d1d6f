#include "models/gltf_reader.h"

#include <stdexcept>

#include "models/gltf_lights.h"
#include "models/gltf_meshes.h"

namespace frond {
namespace {

using Json = nlohmann::json;

/// Returns the map of a translation, a rotation by a quaternion and a scale, which is applied first.
NodeMap map_of(const double* t, const double* q, const double* s) {
  const double size = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], k = size > 0 ? 2 / size : 0;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{s[0] * (1 - k * (y * y + z * z)), s[1] * k * (x * y - z * w), s[2] * k * (x * z + y * w), t[0],
           s[0] * k * (x * y + z * w), s[1] * (1 - k * (x * x + z * z)), s[2] * k * (y * z - x * w), t[1],
           s[0] * k * (x * z - y * w), s[1] * k * (y * z + x * w), s[2] * (1 - k * (x * x + y * y)), t[2]}};
}

/// Returns the map of a node to its parent: its matrix, or else its translation, rotation and scale.
NodeMap map_of(const Json& node) {
  if (member(node, "matrix"))
    return NodeMap::of_columns(numbers(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).data());
  return map_of(numbers(node, "translation", {0, 0, 0}).data(), numbers(node, "rotation", {0, 0, 0, 1}).data(),
                numbers(node, "scale", {1, 1, 1}).data());
}

/// Reads the objects that the scene has, from its nodes to the images of their materials.
class GltfReader {
 public:
  GltfReader(const GltfFile& file, FileSource& files)
      : document_(file.document),
        data_(file, files),
        losses_(file.document),
        meshes_(file.document, data_, losses_, scene_) {}

  /// Nodes first: a skin names nodes that may follow its mesh.
  ImportedScene read() {
    losses_.check("glTF", document_);
    if (const Json* animations = member(document_, "animations"); animations && animations->size() > 1)
      losses_.add("animation", nullptr, false, animations->size() - 1);
    if (const Json* asset = member(document_, "asset")) losses_.check("asset", *asset);
    add_nodes();
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const Json& node = *element(document_, "nodes", nodes_[i]);
      add_meshes(node, nodes_[i], i);
      add_view(node, nodes_[i]);
    }
    if (scene_.meshes.empty()) throw std::runtime_error("it has no triangles");
    scene_.losses = losses_.finish();
    return std::move(scene_);
  }

 private:
  /// Adds the nodes of the first scene, unless the file names another: each after its parent.
  void add_nodes() {
    const Json* scenes = member(document_, "scenes");
    if (scenes && scenes->is_array() && scenes->size() > 1)
      losses_.add("further scene", nullptr, false, scenes->size() - 1);
    const Json* scene = element(document_, "scenes", integer(document_, "scene").value_or(0));
    if (!scene) return;
    losses_.check("scene", *scene);
    add_children(*scene, "nodes", -1);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const Json& node = *element(document_, "nodes", nodes_[i]);
      losses_.check("node", node);
      add_children(node, "children", int32_t(i));
    }
  }

  /// Adds nodes below a parent. The specification demands a tree: a second parent would also make cycles possible.
  void add_children(const Json& parent, std::string_view key, int32_t index) {
    const Json* children = member(parent, key);
    if (!children || !children->is_array()) return;
    for (const Json& child : *children) {
      const Json* node = child.is_number_unsigned() ? element(document_, "nodes", child.get<uint64_t>()) : nullptr;
      if (!node) throw std::runtime_error("a node has a child that does not exist");
      const auto number = child.get<uint64_t>();
      if (!to_world_.try_emplace(number).second)
        throw std::runtime_error(place_of("nodes", number) + " has two parents");
      const NodeMap map = map_of(*node);
      to_world_[number] = index < 0 ? map : to_world_.at(nodes_[size_t(index)]).after(map);
      nodes_.push_back(number);
      scene_.nodes.push_back({.name = std::string(text(*node, "name")), .parent = index, .to_parent = map.m});
    }
  }

  /// Adds the light and the camera of a node.
  void add_view(const Json& node, uint64_t number) {
    const auto add = [&](auto object, auto& to) {
      if (!object) return;
      object->to_world = to_world_.at(number).m;
      to.push_back(*object);
    };
    add(gltf_light(document_, node, losses_), scene_.lights);
    add(gltf_camera(document_, node, losses_), scene_.cameras);
  }

  /// Adds the mesh of a node, to itself or to further nodes.
  void add_meshes(const Json& node, uint64_t number, size_t at) {
    const auto mesh = integer(node, "mesh");
    if (!mesh) return;
    if (!element(document_, "meshes", mesh))
      throw std::runtime_error(place_of("nodes", number) + " names a mesh that does not exist");
    const std::vector<uint32_t>& meshes = meshes_.meshes_of(node, *mesh, to_world_);
    const Json* instancing = extension(node, "EXT_mesh_gpu_instancing");
    if (integer(node, "skin")) {  // joints place its vertices in the world: the transforms of its nodes have no effect
      scene_.nodes.push_back({.name = scene_.nodes[at].name, .parent = -1, .to_parent = NodeMap().m, .meshes = meshes});
    } else if (instancing) {
      add_instances(*instancing, place_of("nodes", number), at, meshes);
    } else {
      scene_.nodes[at].meshes = meshes;
    }
  }

  /// Adds a node for each instance. The attributes have as many elements.
  void add_instances(const Json& instancing, const std::string& place, size_t parent,
                     const std::vector<uint32_t>& meshes) {
    const Json* attributes = member(instancing, "attributes");
    if (!attributes) throw std::runtime_error(place + ": its instances have no attributes");
    losses_.check("instances", *attributes);
    size_t count = 0;
    const auto values = [&](const char* name, size_t width) {
      const auto accessor = integer(*attributes, name);
      auto all = accessor ? data_.numbers<float>(*accessor, width, place + ", " + name) : std::vector<float>();
      if (count > 0 && accessor && all.size() / width != count)
        throw std::runtime_error(place + ": its instances differ in number");
      if (accessor) count = all.size() / width;
      return std::vector<double>(all.begin(), all.end());
    };
    const auto t = values("TRANSLATION", 3), r = values("ROTATION", 4), s = values("SCALE", 3);
    constexpr double kZero[] = {0, 0, 0}, kNoTurn[] = {0, 0, 0, 1}, kOne[] = {1, 1, 1};
    for (size_t i = 0; i < count; ++i)
      scene_.nodes.push_back(
          {.name = scene_.nodes[parent].name,
           .parent = int32_t(parent),
           .to_parent =
               map_of(t.empty() ? kZero : &t[3 * i], r.empty() ? kNoTurn : &r[4 * i], s.empty() ? kOne : &s[3 * i]).m,
           .meshes = meshes});
  }

  const Json& document_;
  ImportedScene scene_;
  GltfData data_;
  GltfLosses losses_;
  GltfMeshes meshes_;
  std::vector<uint64_t> nodes_;    ///< by index in the scene
  GltfMeshes::NodeMaps to_world_;  ///< of the nodes
};

}  // namespace

ImportedScene read_gltf(std::string_view bytes, FileSource& files) {
  const GltfFile file = parse_gltf(bytes);
  const Json* asset = member(file.document, "asset");
  const std::string_view version = asset ? text(*asset, "version") : "",
                         least = asset ? text(*asset, "minVersion") : "";
  if (!file.document.is_object()) throw std::runtime_error("its JSON is no object");
  if (!version.starts_with('2'))
    throw std::runtime_error(version.empty() ? "it states no version of glTF (asset.version)"
                                             : "it is of glTF " + std::string(version) + ", read is glTF 2");
  if (!least.empty() && least != "2.0") throw std::runtime_error("it needs a reader of glTF " + std::string(least));
  return GltfReader(file, files).read();
}

}  // namespace frond
