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

/// Returns the size in bytes.
constexpr size_t size_of(PlyType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}
constexpr bool is_integer(PlyType type) { return type < PlyType::float32; }

/// A property of an element: a scalar or a list.
struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of the value, or of each value of a list
  std::optional<PlyType> count_type;  ///< type of a list's length; empty: not a list
  Location where;
};

/// An element, such as "vertex", with its properties in order.
struct PlyElement {
  std::string name;
  uint64_t count;
  std::vector<PlyProperty> properties;
  Location where;
};

enum class PlyFormat : uint8_t { ascii, little_endian, big_endian };

/// Header of a PLY file (Turk 1994).
struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  size_t bytes = 0;  ///< size of the header: offset of the data
  int lines = 0;
};

/// Throws InputError with line and column.
PlyHeader read_ply_header(std::string_view bytes, const std::shared_ptr<const std::string>& file);

}  // namespace frond
