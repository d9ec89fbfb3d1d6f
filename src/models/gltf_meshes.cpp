#include "models/gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/normal_map_sides.h"

namespace frond {
namespace {

using Json = nlohmann::json;

/// Returns the weights of the morph targets: the node's, or else the mesh's; nothing if all are 0.
std::vector<double> weights_of(const Json& node, const Json& mesh) {
  const Json* weights = member(member(node, "weights") ? node : mesh, "weights");
  std::vector<double> values;
  if (weights && weights->is_array())
    for (const Json& w : *weights) values.push_back(w.is_number() ? w.get<double>() : 0);
  if (std::ranges::all_of(values, [](double w) { return w == 0; })) values.clear();
  return values;
}

std::array<float, 3> stored(const Vec3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

}  // namespace

template <size_t width>
std::vector<std::array<float, width>> GltfMeshes::vertices(const Json& attributes, const std::string& name,
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

const std::vector<uint32_t>& GltfMeshes::meshes_of(const Json& node, uint64_t index, const NodeMaps& to_world) {
  const auto skin = integer(node, "skin");
  const Json& mesh = *element(document_, "meshes", index);
  const std::vector<double> weights = weights_of(node, mesh);
  const auto [known, is_new] = meshes_.try_emplace({index, skin, weights});
  if (!is_new) return known->second;
  if (seen_.insert(index).second) losses_.check("mesh", mesh);
  const Json* primitives = member(mesh, "primitives");
  const std::vector<NodeMap> joints = skin ? joints_of(*skin, to_world) : std::vector<NodeMap>();
  for (size_t i = 0; primitives && primitives->is_array() && i < primitives->size(); ++i)
    add_primitive((*primitives)[i], place_of("meshes", index) + "." + place_of("primitives", i),
                  std::string(text(mesh, "name")), weights, joints, known->second);
  return known->second;
}

std::vector<NodeMap> GltfMeshes::joints_of(uint64_t index, const NodeMaps& to_world) {
  const std::string place = place_of("skins", index);
  const Json* skin = element(document_, "skins", index);
  const Json* joints = skin ? member(*skin, "joints") : nullptr;
  if (!joints || !joints->is_array()) throw std::runtime_error(place + ": it has no joints");
  losses_.check("skin", *skin);
  std::vector<float> inverse;
  if (const auto accessor = integer(*skin, "inverseBindMatrices")) inverse = data_.numbers<float>(*accessor, 16, place);
  std::vector<NodeMap> maps;
  for (const Json& joint : *joints) {
    const auto found = joint.is_number_unsigned() ? to_world.find(joint.get<uint64_t>()) : to_world.end();
    if (found == to_world.end()) throw std::runtime_error(place + ": a joint is no node of the scene");
    const size_t at = 16 * maps.size();
    if (!inverse.empty() && inverse.size() < at + 16)
      throw std::runtime_error(place + ": it has too few inverseBindMatrices");
    maps.push_back(inverse.empty() ? found->second : found->second.after(NodeMap::of_columns(&inverse[at])));
  }
  return maps;
}

void GltfMeshes::add_primitive(const Json& primitive, const std::string& place, const std::string& name,
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
void GltfMeshes::apply_colors(const Json& attributes, const std::string& place, ImportedMesh& mesh) {
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

bool GltfMeshes::has_data(const Json& attributes) const {
  const Json* accessor = element(document_, "accessors", integer(attributes, "POSITION"));
  return accessor && member(*accessor, "bufferView");
}

/// Texture coordinates of the material's first texture; v is 0 at an image's lower edge, at the upper one in glTF.
void GltfMeshes::add_coordinates(const Json& attributes, const std::string& place, ImportedMesh& mesh) {
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

void GltfMeshes::morph(const Json& primitive, const std::string& place, const std::vector<double>& weights,
                       ImportedMesh& mesh) {
  for (size_t i = 0; i < weights.size(); ++i) {
    const Json* target = element(primitive, "targets", i);
    if (!target || weights[i] == 0) continue;
    for (auto& [name, values] : {std::pair("POSITION", &mesh.positions), std::pair("NORMAL", &mesh.normals)}) {
      if (values->empty()) continue;
      const auto by = vertices<3>(*target, name, place + "." + place_of("targets", i), mesh.positions.size());
      for (size_t v = 0; v < by.size(); ++v)
        (*values)[v] = stored(to_double((*values)[v]) + weights[i] * to_double(by[v]));
    }
  }
}

void GltfMeshes::place_by_joints(const Json& attributes, const std::string& place, const std::vector<NodeMap>& joints,
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
    mesh.positions[i] = stored(maps[i].point(to_double(mesh.positions[i])));
    if (!mesh.normals.empty()) mesh.normals[i] = stored(maps[i].normal(to_double(mesh.normals[i])));
  }
}

std::vector<std::array<uint32_t, 3>> GltfMeshes::triangles(const Json& primitive, const std::string& place, double mode,
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

}  // namespace frond
