#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

struct GltfFile {
  nlohmann::json document;
  bool is_binary;          ///< .glb: buffer 0 may be its second chunk
  std::string_view bytes;  ///< of the second chunk
};

/// Parses the JSON of a glTF file, or of its first chunk if the file is a .glb. Throws std::runtime_error for what is
/// not JSON, for an object that has a key twice (readers differ in which one counts), and for a depth above 200.
GltfFile parse_gltf(std::string_view file);

/// Returns the place of an object in the JSON, for messages: "nodes[3]".
inline std::string place_of(const char* array, uint64_t index) { return array + ("[" + std::to_string(index) + "]"); }

// Access to untrusted JSON: values may have any type.

/// Returns an object's member; nullptr if there is none, or `object` is no object.
const nlohmann::json* member(const nlohmann::json& object, std::string_view key);
/// Returns element `index` of the array under a key; nullptr if there is none.
const nlohmann::json* element(const nlohmann::json& object, std::string_view key, std::optional<uint64_t> index);
/// Returns a member that is an integer of 0 or more, below 2^53.
std::optional<uint64_t> integer(const nlohmann::json& object, std::string_view key);
/// Returns a member that is a number; `otherwise` if there is none.
double number(const nlohmann::json& object, std::string_view key, double otherwise);
/// Returns an array of as many numbers as `otherwise` has, which replaces what is not given.
std::vector<double> numbers(const nlohmann::json& object, std::string_view key, std::vector<double> otherwise);
/// Returns an object's extension; nullptr if it has none of this name.
const nlohmann::json* extension(const nlohmann::json& object, std::string_view name);
/// Returns a member that is a text, or an empty one.
std::string_view text(const nlohmann::json& object, std::string_view key);

}  // namespace frond
