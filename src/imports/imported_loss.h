#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace frond {

/// Property of a model that changes its look and has no counterpart in the scene.
struct ImportedLoss {
  std::string what;                         ///< "animation", "gloss", "extension KHR_materials_volume"
  uint64_t count = 0;                       ///< how often; 0: not counted
  std::vector<std::string> materials = {};  ///< that have it, if it is one of materials
  bool is_surface = false;                  ///< of the surface of a material only, so that another material replaces it
  bool operator==(const ImportedLoss&) const = default;
};

/// Collects losses; each is named once.
class LossList {
 public:
  /// A property of the model.
  void add(const std::string& what, uint64_t count = 1);
  /// A property of a material's surface; if `is_shape`, one that every material of the mesh would lose.
  void add_for_material(const std::string& material, const std::string& what, bool is_shape = false);
  const std::vector<ImportedLoss>& all() const { return all_; }

 private:
  ImportedLoss* find(const std::string& what, bool is_of_material);
  std::vector<ImportedLoss> all_;
};

/// Returns the loss for a message: `animation (2 times)`, `gloss of "pot", "rim"`.
std::string text_of(const ImportedLoss& loss);

}  // namespace frond
