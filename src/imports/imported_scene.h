#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "imports/imported_loss.h"

namespace frond {

/// Scene of a model file (OBJ, glTF) as plain data: what the process that reads the file returns.

inline Vec3d to_double(const std::array<float, 3>& v) { return {double(v[0]), double(v[1]), double(v[2])}; }

/// Image that a material names: a file, or bytes that the model file contains.
struct ImportedImage {
  std::string name;                  ///< path as in the model file, or a name for an embedded image
  std::vector<unsigned char> bytes;  ///< content of an embedded image; empty: `name` is a file
  std::string extension;             ///< of an embedded image, without the dot: "png"
  bool operator==(const ImportedImage&) const = default;
};

/// Use of an image by a material.
struct ImportedTexture {
  int32_t image = -1;  ///< index; -1: no texture
  uint32_t uv_set = 0;
  std::array<float, 6> to_image{1, 0, 0, 0, 1, 0};  ///< affine map of texture coordinates, two rows of a 2 x 3 matrix
  enum class Wrap : uint8_t { repeat, clamp, mirror } wrap = Wrap::repeat;
  /// Whether both use the same texture coordinates.
  bool shares_uv(const ImportedTexture& other) const { return uv_set == other.uv_set && to_image == other.to_image; }
  bool operator==(const ImportedTexture&) const = default;
};

struct ImportedMaterial {
  enum class Alpha : uint8_t { opaque, mask, blend };

  std::string name;
  std::array<float, 3> color{0.6f, 0.6f, 0.6f};  ///< linear sRGB; a factor if there is a texture
  float opacity = 1;
  Alpha alpha = Alpha::blend;  ///< use of the opacity and of the alpha channel of `color_texture`
  float cutoff = 0.5f;         ///< Alpha::mask: opacity below it counts as 0, otherwise as 1
  ImportedTexture color_texture = {}, opacity_texture = {}, normal_texture = {};
  std::array<float, 2> normal_scale{1, 1};  ///< factors of x and y of the normal map
  float metalness = 0, roughness = 1;
  /// Share of the diffuse light that is transmitted, with a colour of its own; the alpha channel of the first texture
  /// is a factor of the share, the second texture one of the colour.
  float transmission = 0;
  std::array<float, 3> transmitted{1, 1, 1};
  ImportedTexture transmission_texture = {}, transmitted_texture = {};
  float ior = 0;                    ///< index of refraction of a clear surface; 0: it is opaque
  float thickness = 0;              ///< of a clear surface; above 0: it encloses a volume, otherwise it is a thin pane
  std::array<float, 3> emission{};  ///< luminance of each channel of linear sRGB, cd/m^2; a factor of the texture
  ImportedTexture emission_texture = {};
  bool has_two_sides = true;  ///< that emit

  bool is_emitter() const { return emission != std::array<float, 3>{}; }
  std::array<const ImportedTexture*, 6> textures() const {
    return {&color_texture,       &opacity_texture,      &normal_texture,
            &transmitted_texture, &transmission_texture, &emission_texture};
  }
  /// The texture whose coordinates meshes have; they are already mapped by its `to_image`.
  const ImportedTexture& uv_texture() const {
    for (const ImportedTexture* texture : textures())
      if (texture->image >= 0) return *texture;
    return color_texture;
  }
  bool operator==(const ImportedMaterial&) const = default;
};

/// Triangles of one material. Vertex attributes are empty or as many as positions.
struct ImportedMesh {
  std::string name;
  uint32_t material = 0;
  std::vector<std::array<float, 3>> positions = {}, normals = {};
  std::vector<std::array<float, 2>> uvs = {};  ///< (0, 0) is the lower left corner of an image
  std::vector<std::array<uint32_t, 3>> triangles = {};
  bool operator==(const ImportedMesh&) const = default;
};

/// Node of the hierarchy. A parent precedes its children.
struct ImportedNode {
  std::string name;
  int32_t parent = -1;                 ///< index; -1: none
  std::array<double, 12> to_parent{};  ///< three rows of a 3 x 4 matrix
  std::vector<uint32_t> meshes = {};
  bool operator==(const ImportedNode&) const = default;
};

/// Light without a surface.
struct ImportedLight {
  enum class Type : uint8_t { point, spot, distant } type = Type::point;
  std::array<double, 3> color{};      ///< of linear sRGB: intensity in cd; of a distant light illuminance in lx
  double inner = 0, outer = 0;        ///< of a spot: angles from its axis of full and of no intensity, radians
  std::array<double, 12> to_world{};  ///< as of nodes; the light is at the origin and shines along -z
  bool operator==(const ImportedLight&) const = default;
};

struct ImportedCamera {
  bool is_orthographic = false;
  std::array<double, 2> half{};       ///< half the image along x and y: at the distance 1, or anywhere if orthographic
  std::array<double, 12> to_world{};  ///< as of nodes; the camera is at the origin, looks along -z, and y is up
  bool operator==(const ImportedCamera&) const = default;
};

struct ImportedScene {
  std::vector<ImportedImage> images;
  std::vector<ImportedMaterial> materials;
  std::vector<ImportedMesh> meshes;
  std::vector<ImportedNode> nodes;
  std::vector<ImportedLight> lights;
  std::vector<ImportedCamera> cameras;
  std::array<double, 3> origin{};  ///< point of the model that all positions are relative to: OBJ in map coordinates
  std::vector<ImportedLoss> losses;
  std::vector<std::string> warnings;

  /// Returns the index of a material, which is added if there is none like it.
  uint32_t add(ImportedMaterial material) {
    const auto found = std::ranges::find(materials, material);
    if (found == materials.end()) {
      materials.push_back(std::move(material));
      return uint32_t(materials.size() - 1);
    }
    return uint32_t(found - materials.begin());
  }
  bool operator==(const ImportedScene&) const = default;
};

}  // namespace frond
