#pragma once

#include <set>
#include <string>
#include <vector>

#include "imports/imported_loss.h"
#include "models/gltf_json.h"

namespace frond {

/// Compares the objects of a glTF document with the record of what the import reads (gltf_properties.h), and collects
/// what changes the look and is not read.
class GltfLosses {
 public:
  /// Throws std::runtime_error for required extensions that are not read.
  explicit GltfLosses(const nlohmann::json& document);

  /// Reports the properties of an object that are not read. `material`: to which the object belongs; nullptr: to none.
  void check(std::string_view kind, const nlohmann::json& object, const std::string* material = nullptr);
  /// Records a loss. `is_surface`: of the surface of the material, so that it does not matter if another replaces it.
  void add(const std::string& what, const std::string* material = nullptr, bool is_surface = true, uint64_t count = 1);
  /// Returns all losses. To be called at the end: extensions that no object has are among them.
  std::vector<ImportedLoss> finish();

 private:
  /// Reports the extensions of an object that are not read, and compares the properties of the others.
  void check_extensions(std::string_view kind, const nlohmann::json& all, const std::string* material);

  LossList losses_;
  std::set<std::string> defined_;  ///< extensions that the document states to use or defines
  std::set<std::string> named_;    ///< extensions that a loss names
};

}  // namespace frond
