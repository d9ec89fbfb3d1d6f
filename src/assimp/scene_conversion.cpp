#include "assimp/scene_conversion.h"

#include <assimp/mesh.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace frond {
namespace {

/// Whether no component is infinite or not a number.
bool is_finite(const aiVector3D& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Normals are left out if one of them is not finite; the library may compute them from faces without area.
ImportedMesh converted(const aiMesh& mesh, const ImportedTexture& texture) {
  ImportedMesh m{.name = mesh.mName.C_Str(), .material = mesh.mMaterialIndex};
  const auto vertices = [&mesh](const aiVector3D* from, auto& to) {
    to.resize(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i)
      for (unsigned k = 0; k < to[i].size(); ++k) to[i][k] = from[i][k];
  };
  vertices(mesh.mVertices, m.positions);
  if (mesh.HasNormals() && std::all_of(mesh.mNormals, mesh.mNormals + mesh.mNumVertices, is_finite))
    vertices(mesh.mNormals, m.normals);
  const uint32_t uv_set = texture.uv_set;
  if (uv_set < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.HasTextureCoords(uv_set)) {
    const aiVector3D* uv = mesh.mTextureCoords[uv_set];
    if (std::all_of(uv, uv + mesh.mNumVertices, is_finite)) vertices(uv, m.uvs);
    const auto& t = texture.to_image;
    for (auto& [u, v] : m.uvs) std::tie(u, v) = std::tuple(t[0] * u + t[1] * v + t[2], t[3] * u + t[4] * v + t[5]);
  }
  m.triangles.reserve(mesh.mNumFaces);
  for (unsigned i = 0; i < mesh.mNumFaces; ++i)
    if (const aiFace& face = mesh.mFaces[i]; face.mNumIndices == 3)
      m.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  return m;
}

/// Adds a node and those below it. The library's hierarchy is a tree; its depth is limited here, because the file is
/// untrusted.
void add_nodes(const aiNode& node, int32_t parent, int depth, const std::vector<int32_t>& mesh_of,
               std::vector<ImportedNode>& nodes) {
  constexpr int kDeepest = 10'000;
  if (depth > kDeepest) throw std::runtime_error("its nodes are more than 10,000 deep");
  ImportedNode n{.name = node.mName.C_Str(), .parent = parent};
  for (unsigned row = 0; row < 3; ++row)
    for (unsigned column = 0; column < 4; ++column) n.to_parent[4 * row + column] = node.mTransformation[row][column];
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    if (const int32_t mesh = mesh_of.at(node.mMeshes[i]); mesh >= 0) n.meshes.push_back(uint32_t(mesh));
  const auto index = int32_t(nodes.size());
  nodes.push_back(std::move(n));
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_nodes(*node.mChildren[i], index, depth + 1, mesh_of, nodes);
}

}  // namespace

/// Points and lines are left out, and nodes keep their order: a parent precedes its children.
ImportedScene converted(const aiScene& scene) {
  ImportedScene result;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i)
    result.materials.push_back(converted(*scene.mMaterials[i], scene, result.images));
  std::vector<int32_t> mesh_of;  // -1: no triangles
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    const ImportedMaterial& material = result.materials.at(mesh.mMaterialIndex);
    const bool has_triangles = (mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0 && mesh.HasFaces();
    mesh_of.push_back(has_triangles ? int32_t(result.meshes.size()) : -1);
    if (has_triangles) result.meshes.push_back(converted(mesh, material.uv_texture()));
  }
  if (result.meshes.empty() || !scene.mRootNode) throw std::runtime_error("it has no triangles");
  add_nodes(*scene.mRootNode, -1, 0, mesh_of, result.nodes);
  return result;
}

}  // namespace frond
