#include "models/gltf_losses.h"

#include <stdexcept>

#include "models/gltf_properties.h"

namespace frond {
namespace {

using Json = nlohmann::json;

/// Returns an array's texts, or none.
std::vector<std::string> texts_of(const Json& object, std::string_view key) {
  std::vector<std::string> words;
  if (const Json* array = member(object, key); array && array->is_array())
    for (const Json& word : *array)
      if (word.is_string()) words.push_back(word.get<std::string>());
  return words;
}

}  // namespace

/// A reader must refuse a file that requires an extension which it does not know (3.12 of the specification).
GltfLosses::GltfLosses(const Json& document) {
  for (const std::string& name : texts_of(document, "extensionsUsed")) defined_.insert(name);
  std::string names;
  size_t count = 0;
  for (const std::string& name : texts_of(document, "extensionsRequired"))
    if (!is_read_extension(name)) names += (count++ == 0 ? "" : ", ") + name;
  if (count > 0)
    throw std::runtime_error(
        std::string(count == 1 ? "it requires an extension that is" : "it requires extensions that are") +
        " not read: " + names + " (extensionsRequired); export it without");
}

/// Values of properties that have no effect are compared as JSON: 1 and 1.0 are equal.
void GltfLosses::check(std::string_view kind, const Json& object, const std::string* material) {
  if (!object.is_object()) return;
  for (const auto& [key, value] : object.items()) {
    if (key == "extras") continue;  // of applications
    if (key == "extensions") {
      check_extensions(kind, value, material);
      continue;
    }
    const GltfProperty* property = gltf_property(kind, key);
    if (!property) {
      add("unknown property " + std::string(kind) + "." + key, material, false);
    } else if (property->use == GltfUse::lost || property->use == GltfUse::surface) {
      const bool has_effect =
          property->no_effect.empty() || value != Json::parse(property->no_effect.begin(), property->no_effect.end());
      const std::string says(property->says.empty() ? std::string(kind) + "." + key : property->says);
      if (has_effect) add(says, material, property->use == GltfUse::surface);
    }
  }
}

/// Extensions of materials are of their surface.
void GltfLosses::check_extensions(std::string_view kind, const Json& all, const std::string* material) {
  if (!all.is_object()) return;
  for (const auto& [name, extension] : all.items()) {
    if (kind == "glTF") {  // definitions, which objects refer to
      defined_.insert(name);
    } else if (is_read_extension(name)) {
      check(name, extension, material);
    } else {
      named_.insert(name);
      add("extension " + name, material, kind == "material");
    }
  }
}

void GltfLosses::add(const std::string& what, const std::string* material, bool is_surface, uint64_t count) {
  if (material)
    losses_.add_for_material(*material, what, !is_surface);
  else
    losses_.add(what, count);
}

std::vector<ImportedLoss> GltfLosses::finish() {
  for (const std::string& name : defined_)
    if (!is_read_extension(name) && !named_.contains(name)) losses_.add("extension " + name, 0);
  return losses_.all();
}

}  // namespace frond
