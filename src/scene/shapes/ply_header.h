#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr size_t size_of(PlyType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}
constexpr bool is_integer(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of the value, or of each value of a list
  std::optional<PlyType> count_type;  ///< of a list's length; empty: one value
  Location where;
};

struct PlyElement {
  std::string name;
  uint64_t count;
  std::vector<PlyProperty> properties;
  Location where;
};

enum class PlyFormat : uint8_t { ascii, little_endian, big_endian };

/// What a PLY file says of itself (Turk 1994).
struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  size_t bytes = 0;  ///< of the header: the data begin here
  int lines = 0;
};

/// Throws InputError with line and column.
PlyHeader read_ply_header(std::string_view bytes, const std::shared_ptr<const std::string>& file);

}  // namespace frond
