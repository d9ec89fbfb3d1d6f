#include "models/gltf_reader.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <tuple>

#include "imports/node_map.h"
#include "models/gltf_lights.h"
#include "models/gltf_materials.h"
#include "models/normal_map_sides.h"

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

/// Returns the map of a matrix of glTF, which is stored by columns.
template <class T>
NodeMap map_of(const T* columns) {
  NodeMap map;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) map.m[4 * i + j] = double(columns[4 * j + i]);
  return map;
}

/// Returns the map of a node to its parent: its matrix, or else its translation, rotation and scale.
NodeMap map_of(const Json& node) {
  if (member(node, "matrix"))
    return map_of(numbers(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).data());
  return map_of(numbers(node, "translation", {0, 0, 0}).data(), numbers(node, "rotation", {0, 0, 0, 1}).data(),
                numbers(node, "scale", {1, 1, 1}).data());
}

/// Returns the weights of the morph targets: the node's, or else the mesh's; nothing if all are 0.
std::vector<double> weights_of(const Json& node, const Json& mesh) {
  const Json* weights = member(member(node, "weights") ? node : mesh, "weights");
  std::vector<double> values;
  if (weights && weights->is_array())
    for (const Json& w : *weights) values.push_back(w.is_number() ? w.get<double>() : 0);
  if (std::ranges::all_of(values, [](double w) { return w == 0; })) values.clear();
  return values;
}

/// Returns the place of an object in the JSON, for messages.
std::string place_of(const char* array, uint64_t index) { return array + ("[" + std::to_string(index) + "]"); }

/// Vectors as they are stored in single precision, and as they are computed with.
Vec3d vec(const std::array<float, 3>& v) { return {double(v[0]), double(v[1]), double(v[2])}; }
std::array<float, 3> stored(const Vec3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// Reads the objects that the scene has, from its nodes to the images of their materials.
class GltfReader {
 public:
  GltfReader(const GltfFile& file, FileSource& files)
      : document_(file.document),
        data_(file, files),
        losses_(file.document),
        materials_(file.document, data_, losses_, scene_) {}

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
    const auto mesh = integer(node, "mesh"), skin = integer(node, "skin");
    if (!mesh) return;
    if (!element(document_, "meshes", mesh))
      throw std::runtime_error(place_of("nodes", number) + " names a mesh that does not exist");
    const std::vector<uint32_t>& meshes = meshes_of(node, *mesh, skin);
    const Json* instancing = extension(node, "EXT_mesh_gpu_instancing");
    if (skin) {  // joints place its vertices in the world: the transforms of its nodes have no effect
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

  /// Returns the meshes in the scene of a mesh under a skin and weights of its morph targets, made once.
  const std::vector<uint32_t>& meshes_of(const Json& node, uint64_t index, std::optional<uint64_t> skin) {
    const Json& mesh = *element(document_, "meshes", index);
    const std::vector<double> weights = weights_of(node, mesh);
    const auto [known, is_new] = meshes_.try_emplace({index, skin, weights});
    if (!is_new) return known->second;
    if (seen_.insert(index).second) losses_.check("mesh", mesh);
    const Json* primitives = member(mesh, "primitives");
    const std::vector<NodeMap> joints = skin ? joints_of(*skin) : std::vector<NodeMap>();
    for (size_t i = 0; primitives && primitives->is_array() && i < primitives->size(); ++i)
      add_primitive((*primitives)[i], place_of("meshes", index) + "." + place_of("primitives", i),
                    std::string(text(mesh, "name")), weights, joints, known->second);
    return known->second;
  }

  /// Returns the maps of a skin's joints from its vertices to the world.
  std::vector<NodeMap> joints_of(uint64_t index) {
    const std::string place = place_of("skins", index);
    const Json* skin = element(document_, "skins", index);
    const Json* joints = skin ? member(*skin, "joints") : nullptr;
    if (!joints || !joints->is_array()) throw std::runtime_error(place + ": it has no joints");
    losses_.check("skin", *skin);
    std::vector<float> inverse;
    if (const auto accessor = integer(*skin, "inverseBindMatrices"))
      inverse = data_.numbers<float>(*accessor, 16, place);
    std::vector<NodeMap> maps;
    for (const Json& joint : *joints) {
      const auto found = joint.is_number_unsigned() ? to_world_.find(joint.get<uint64_t>()) : to_world_.end();
      if (found == to_world_.end()) throw std::runtime_error(place + ": a joint is no node of the scene");
      const size_t at = 16 * maps.size();
      if (!inverse.empty() && inverse.size() < at + 16)
        throw std::runtime_error(place + ": it has too few inverseBindMatrices");
      maps.push_back(inverse.empty() ? found->second : found->second.after(map_of(&inverse[at])));
    }
    return maps;
  }

  /// Reads the triangles of a primitive. Its attributes are as many as its positions.
  void add_primitive(const Json& primitive, const std::string& place, const std::string& name,
                     const std::vector<double>& weights, const std::vector<NodeMap>& joints,
                     std::vector<uint32_t>& to) {
    losses_.check("primitive", primitive);
    constexpr double kTriangles = 4, kFan = 6;
    const double mode = number(primitive, "mode", kTriangles);
    if (mode < kTriangles) return losses_.add("primitive of points or lines");
    if (mode > kFan) throw std::runtime_error(place + ": there is no mode " + std::to_string(mode));
    const Json* attributes = member(primitive, "attributes");
    if (!attributes || !member(*attributes, "POSITION")) return losses_.add("primitive without positions");
    losses_.check("attributes", *attributes);
    if (extension(primitive, "KHR_draco_mesh_compression") && !has_data(*attributes))
      throw std::runtime_error(place + ": its values are compressed by KHR_draco_mesh_compression, which is not read");
    ImportedMesh mesh{.name = name, .material = materials_.index_of(integer(primitive, "material"))};
    mesh.positions = vertices<3>(*attributes, "POSITION", place, 0);
    const size_t count = mesh.positions.size();
    apply_colors(*attributes, place, mesh);
    mesh.normals = vertices<3>(*attributes, "NORMAL", place, count);
    add_coordinates(*attributes, place, mesh);
    const auto tangents = vertices<4>(*attributes, "TANGENT", place, count);
    morph(primitive, place, weights, mesh);
    if (!joints.empty()) place_by_joints(*attributes, place, joints, mesh);
    mesh.triangles = triangles(primitive, place, mode, count);
    if (mesh.triangles.empty()) return;
    const std::string material = scene_.materials[mesh.material].name;
    const bool is_moved = !weights.empty() || !joints.empty();
    if (add_by_side(std::move(mesh), tangents, scene_, to) && !is_moved)
      losses_.add("direction of TANGENT, which differs from that of the texture coordinates,", &material, false);
  }

  /// Vertex colours are factors of the base colour. Those that all vertices share are of a material; others are lost.
  void apply_colors(const Json& attributes, const std::string& place, ImportedMesh& mesh) {
    const auto index = integer(attributes, "COLOR_0");
    if (!index) return;
    const Json* accessor = element(document_, "accessors", index);
    const size_t width = accessor && text(*accessor, "type") == "VEC4" ? 4 : 3, count = mesh.positions.size();
    const std::vector<float> c = data_.numbers<float>(*index, width, place + ", COLOR_0");
    if (c.size() != count * width) throw std::runtime_error(place + ", COLOR_0: there are not as many as positions");
    ImportedMaterial material = scene_.materials[mesh.material];
    const bool has_alpha = width == 4 && material.alpha != ImportedMaterial::Alpha::opaque;
    for (size_t i = 0; i < c.size(); ++i)
      if (c[i] != c[i % width] && (i % width < 3 || has_alpha))
        return losses_.add("colours of vertices that differ (COLOR_0)", &material.name);
    for (size_t k = 0; k < 3; ++k) material.color[k] *= std::clamp(c[k], 0.f, 1.f);
    if (has_alpha) material.opacity *= std::clamp(c[3], 0.f, 1.f);
    mesh.material = scene_.add(std::move(material));
  }

  /// Whether the positions are also there without the extension that compresses them.
  bool has_data(const Json& attributes) const {
    const Json* accessor = element(document_, "accessors", integer(attributes, "POSITION"));
    return accessor && member(*accessor, "bufferView");
  }

  /// Returns an attribute of `count` vertices, or nothing; any number of them if `count` is 0.
  template <size_t width>
  std::vector<std::array<float, width>> vertices(const Json& attributes, const std::string& name,
                                                 const std::string& place, size_t count) {
    const auto accessor = integer(attributes, name);
    if (!accessor) return {};
    const std::vector<float> values = data_.numbers<float>(*accessor, width, place + ", " + name);
    if (count > 0 && values.size() != count * width)
      throw std::runtime_error(place + ", " + name + ": there are not as many as positions");
    std::vector<std::array<float, width>> result(values.size() / width);
    for (size_t i = 0; i < values.size(); ++i) result[i / width][i % width] = values[i];
    return result;
  }

  /// Texture coordinates of the material's first texture; v is 0 at an image's lower edge, at the upper one in glTF.
  void add_coordinates(const Json& attributes, const std::string& place, ImportedMesh& mesh) {
    const ImportedMaterial& material = scene_.materials[mesh.material];
    const ImportedTexture& texture = material.uv_texture();
    for (const ImportedTexture* t : material.textures())
      if (t->image >= 0 && !member(attributes, "TEXCOORD_" + std::to_string(t->uv_set)))
        losses_.add("image of a primitive that has no TEXCOORD_" + std::to_string(t->uv_set));
    mesh.uvs = vertices<2>(attributes, "TEXCOORD_" + std::to_string(texture.uv_set), place, mesh.positions.size());
    const auto& m = texture.to_image;
    for (auto& [u, v] : mesh.uvs) {
      const float up = 1 - v;
      std::tie(u, v) = std::tuple(m[0] * u + m[1] * up + m[2], m[3] * u + m[4] * up + m[5]);
    }
    if (std::ranges::all_of(mesh.uvs, [](const auto& uv) { return std::isfinite(uv[0]) && std::isfinite(uv[1]); }))
      return;
    mesh.uvs.clear();
    losses_.add("TEXCOORD_" + std::to_string(texture.uv_set) + " of a primitive, which has values that are not finite");
  }

  /// Adds the displacements of the morph targets.
  void morph(const Json& primitive, const std::string& place, const std::vector<double>& weights, ImportedMesh& mesh) {
    for (size_t i = 0; i < weights.size(); ++i) {
      const Json* target = element(primitive, "targets", i);
      if (!target || weights[i] == 0) continue;
      for (auto& [name, values] : {std::pair("POSITION", &mesh.positions), std::pair("NORMAL", &mesh.normals)}) {
        if (values->empty()) continue;
        const auto by = vertices<3>(*target, name, place + "." + place_of("targets", i), mesh.positions.size());
        for (size_t v = 0; v < by.size(); ++v) (*values)[v] = stored(vec((*values)[v]) + weights[i] * vec(by[v]));
      }
    }
  }

  /// Moves the vertices to the world by the weighted maps of their joints.
  void place_by_joints(const Json& attributes, const std::string& place, const std::vector<NodeMap>& joints,
                       ImportedMesh& mesh) {
    std::vector<NodeMap> maps(mesh.positions.size(), NodeMap{{}});
    std::vector<double> sums(maps.size());
    for (int set = 0;; ++set) {
      const std::string name = "JOINTS_" + std::to_string(set);
      const auto accessor = integer(attributes, name);
      const auto weights = vertices<4>(attributes, "WEIGHTS_" + std::to_string(set), place, maps.size());
      if (!accessor || weights.empty()) break;
      const auto indices = data_.numbers<uint32_t>(*accessor, 4, place + ", " + name);
      if (indices.size() != 4 * maps.size())
        throw std::runtime_error(place + ", " + name + ": there are not as many as positions");
      for (size_t i = 0; i < indices.size(); ++i) {
        const double weight = double(weights[i / 4][i % 4]);
        if (weight == 0) continue;
        if (indices[i] >= joints.size())
          throw std::runtime_error(place + ", " + name + ": its skin has no joint " + std::to_string(indices[i]));
        sums[i / 4] += weight;
        for (size_t k = 0; k < 12; ++k) maps[i / 4].m[k] += weight * joints[indices[i]].m[k];
      }
    }
    for (size_t i = 0; i < maps.size(); ++i) {
      if (!(sums[i] > 0)) throw std::runtime_error(place + ": a vertex of a mesh with a skin has no weights");
      for (double& m : maps[i].m) m /= sums[i];
      mesh.positions[i] = stored(maps[i].point(vec(mesh.positions[i])));
      if (!mesh.normals.empty()) mesh.normals[i] = stored(maps[i].normal(vec(mesh.normals[i])));
    }
  }

  /// Triangles of a list, a strip or a fan.
  std::vector<std::array<uint32_t, 3>> triangles(const Json& primitive, const std::string& place, double mode,
                                                 size_t count) {
    std::vector<uint32_t> indices;
    if (const auto accessor = integer(primitive, "indices")) {
      indices = data_.numbers<uint32_t>(*accessor, 1, place + ", indices");
    } else {
      indices.resize(count);
      for (size_t i = 0; i < count; ++i) indices[i] = uint32_t(i);
    }
    for (const uint32_t i : indices)
      if (i >= count) throw std::runtime_error(place + ", indices: there is no vertex " + std::to_string(i));
    constexpr double kStrip = 5, kFan = 6;
    const size_t step = mode < kStrip ? 3 : 1;
    std::vector<std::array<uint32_t, 3>> result;
    for (size_t i = 0; i + 2 < indices.size(); i += step) {
      const bool is_odd = mode == kStrip && i % 2 == 1;
      result.push_back({indices[mode == kFan ? 0 : i], indices[i + (is_odd ? 2 : 1)], indices[i + (is_odd ? 1 : 2)]});
    }
    return result;
  }

  using MeshKey = std::tuple<uint64_t, std::optional<uint64_t>, std::vector<double>>;

  const Json& document_;
  ImportedScene scene_;
  GltfData data_;
  GltfLosses losses_;
  GltfMaterials materials_;
  std::vector<uint64_t> nodes_;           ///< by index in the scene
  std::map<uint64_t, NodeMap> to_world_;  ///< of the nodes
  std::map<MeshKey, std::vector<uint32_t>> meshes_;
  std::set<uint64_t> seen_;  ///< meshes whose properties were compared
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
