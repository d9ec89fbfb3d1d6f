#pragma once

#include <cstdint>
#include <string>

// To be included after <nlohmann/json.hpp>, which no header of frond includes: it takes long to compile.
namespace frond {

/// Type that an accessor must have for the reader library to read it correctly.
enum class AccessorUse : uint8_t { position, normal, texture_coordinates, indices };

/// Returns the number of elements of an accessor. Throws std::runtime_error that begins with `place` if the library
/// would misread it: integers in place of floats, bytes that its buffer does not have, no data at all. `is_binary`:
/// buffer 0 may be the second chunk of the file.
uint64_t check_accessor(const nlohmann::json& document, uint64_t index, AccessorUse use, const std::string& place,
                        bool is_binary);

}  // namespace frond
