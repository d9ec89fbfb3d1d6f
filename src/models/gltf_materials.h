#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "imports/imported_scene.h"
#include "models/gltf_data.h"
#include "models/gltf_losses.h"

namespace frond {

/// Reads the materials that primitives have, with their images, into a scene; each once.
class GltfMaterials {
 public:
  GltfMaterials(const nlohmann::json& document, GltfData& data, GltfLosses& losses, ImportedScene& scene)
      : document_(document), data_(data), losses_(losses), scene_(scene) {}

  /// Returns the index in the scene of the material with an index of the file; of the default material for none.
  uint32_t index_of(std::optional<uint64_t> material);

 private:
  /// Returns a material of the file, and adds its losses.
  ImportedMaterial read(const nlohmann::json& material);
  /// Reads base colour, metalness and roughness, or the colour of specular and glossiness.
  void read_base(const nlohmann::json& material, ImportedMaterial& m);
  void read_transmission(const nlohmann::json& material, ImportedMaterial& m);
  void read_emission(const nlohmann::json& material, ImportedMaterial& m);
  /// Returns the texture under a key; one without an image if there is none.
  ImportedTexture texture(const nlohmann::json& object, std::string_view key);
  /// Returns the index in the scene of a texture's image; -1 with a loss if it has none.
  int32_t image_of(const nlohmann::json& texture);

  const nlohmann::json& document_;
  GltfData& data_;
  GltfLosses& losses_;
  ImportedScene& scene_;
  std::string name_;  ///< of the material that is read
  std::map<std::optional<uint64_t>, uint32_t> materials_;
  std::map<uint64_t, int32_t> images_;
};

}  // namespace frond
