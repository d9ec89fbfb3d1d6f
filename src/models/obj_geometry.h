#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "imports/imported_scene.h"

namespace frond {

/// Elements of OBJ that faces name, in double precision: a kind's numbers, in the order of the file.
enum ObjKind : uint8_t { kVertex, kTexture, kNormal };
using ObjElements = std::array<std::vector<std::array<double, 3>>, 3>;

/// Corner of a face: vertex, texture coordinates, normal; from 1, 0: none.
using ObjCorner = std::array<uint64_t, 3>;
/// Hash of a corner: products with odd constants (of SplitMix64) mix the bits.
struct ObjCornerHash {
  size_t operator()(const ObjCorner& c) const {
    return size_t(((c[0] * 0x9e3779b97f4a7c15) ^ c[1]) * 0xff51afd7ed558ccd ^ c[2]);
  }
};

/// Faces of one object and material, with or without texture coordinates and normals.
struct ObjFaces {
  std::vector<ObjCorner> vertices = {};
  std::unordered_map<ObjCorner, uint32_t, ObjCornerHash> index = {};
  std::vector<uint32_t> corners = {}, sizes = {};  ///< of the faces: vertices, and how many each has
};

/// Returns the point that the vertices are to be relative to: 0 unless all but a few are far.
std::array<double, 3> obj_origin(const std::vector<std::array<double, 3>>& vertices);

/// Adds vertices and triangles of faces to a mesh, relative to the origin of the scene, with the texture coordinates of
/// the mesh's material.
void add_geometry(const ObjFaces& faces, const ObjElements& elements, bool has_uv, bool has_normal,
                  const ImportedScene& scene, ImportedMesh& mesh);

}  // namespace frond
