#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace frond {

/// Treatment of a property of glTF 2.0 by the import.
enum class GltfUse : uint8_t {
  read,     ///< it has its counterpart in the scene
  inert,    ///< it does not change the look: names, sizes, hints
  lost,     ///< it has no counterpart, and is named
  surface,  ///< lost; of a material's surface, so that it does not matter where another material replaces it
};

/// Properties of an object of glTF 2.0: section 5 of its specification (Properties Reference), and of the extensions
/// that are read.
struct GltfProperty {
  std::string_view object;  ///< kind of the object, as the specification names it
  std::string_view names;   ///< keys, separated by blanks. With * at its end: all keys that begin so
  GltfUse use;
  std::string_view says = {};       ///< in messages; empty: "OBJECT.NAME"
  std::string_view no_effect = {};  ///< JSON of a value that changes nothing
};

/// The record of all properties. Properties that it lacks are reported as unknown.
std::span<const GltfProperty> gltf_properties();
/// Returns the property of a kind of objects; nullptr if it is unknown.
const GltfProperty* gltf_property(std::string_view object, std::string_view name);

/// Whether the extension is read: completely, but for properties that `gltf_properties` has as lost.
bool is_read_extension(std::string_view name);

}  // namespace frond
