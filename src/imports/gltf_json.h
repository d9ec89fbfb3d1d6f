#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

// To be included after <nlohmann/json.hpp>, which no header of frond includes: it takes long to compile.
namespace frond {

/// Parses the JSON of a glTF file, or of its first chunk if the file is a .glb. Throws std::runtime_error for what is
/// not JSON, for an object that has a key twice (readers differ in which one counts), and for a depth above 200.
nlohmann::json gltf_json(std::string_view file);

// Access to untrusted JSON: values may have any type.

/// Returns an object's member; nullptr if there is none, or `object` is no object.
const nlohmann::json* member(const nlohmann::json& object, std::string_view key);
/// Returns element `index` of the array under a key; nullptr if there is none.
const nlohmann::json* element(const nlohmann::json& object, std::string_view key, std::optional<uint64_t> index);
/// Returns a member that is an integer of 0 or more, below 2^53.
std::optional<uint64_t> integer(const nlohmann::json& object, std::string_view key);
double number(const nlohmann::json& object, std::string_view key, double otherwise);
std::string_view text(const nlohmann::json& object, std::string_view key);

}  // namespace frond
