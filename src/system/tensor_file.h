#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

/// Whether a file begins as a tensor file does.
bool is_tensor_file(std::string_view bytes);

/// Tensor file: named arrays of numbers (https://rgl.epfl.ch/materials). Layout, little-endian: "tensor_file\0"; two
/// bytes of version, 1 and 0; uint32 number of fields; then for each field uint16 length of the name, the name, uint16
/// number of dimensions, uint8 type, uint64 offset of the array from the start of the file, uint64 for each dimension.
class TensorFile {
 public:
  /// Types of numbers, as in the file; there are others.
  static constexpr uint8_t kUint8 = 1, kFloat32 = 10;
  /// An array of a file.
  struct Field {
    std::string_view name;
    uint8_t type;
    std::vector<size_t> shape;  ///< the last index varies fastest
    size_t count;               ///< product of the shape
    std::string_view bytes;     ///< `count` numbers
  };

  /// Reads the descriptions of all fields. `name` and `where` are for messages. Throws InputError for a file that is
  /// truncated or has a field outside of it.
  TensorFile(std::string bytes, std::string name, Location where);

  const std::vector<Field>& fields() const { return fields_; }
  /// Whether there is a field of this name.
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Throws InputError, as `refuse`, if there is no such field of 32-bit floats with so many dimensions.
  const Field& floats(std::string_view name, size_t dimensions) const;
  /// Returns the numbers of such a field. Throws InputError for numbers that are not finite or below `least`.
  static constexpr float kAnyNumber = -3.4028235e38f;
  std::vector<float> numbers(const Field& field, float least = kAnyNumber) const;
  /// Throws InputError with the name of the file and what is wrong with it.
  [[noreturn]] void reject(std::string_view why) const;

 private:
  const Field* find(std::string_view name) const;

  std::string bytes_, name_;
  Location where_;
  std::vector<Field> fields_;
};

/// Returns the content of a file with these fields. `count` is not used; `bytes` must fit type and shape.
std::string tensor_file_of(std::span<const TensorFile::Field> fields);

}  // namespace frond
