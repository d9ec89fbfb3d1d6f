#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

/// A field of a NumPy file's rows.
struct NpyField {
  std::string name;           ///< empty: the rows of a plain array
  std::string type;           ///< NumPy's notation: "<f4"
  std::vector<size_t> shape;  ///< empty: a scalar
  size_t offset = 0;          ///< bytes from the beginning of the row

  /// Returns the number of scalars; above 2^30 a number that is too large, not their exact number.
  size_t count() const;
  size_t bytes() const;
};

/// Layout of a .npy file: consecutive rows with equal fields.
struct NpyLayout {
  std::vector<NpyField> fields;
  size_t rows = 0, row_bytes = 0;
  size_t begin = 0;  ///< offset of the first row in the file, bytes
};

/// Throws InputError at `where` for a file that is not a .npy file, is truncated, or is in Fortran order. `name` names
/// the data in messages. `file_size`: of the whole file, if `file` is only its beginning.
NpyLayout read_npy_layout(std::span<const std::byte> file, std::string_view name, const Location& where,
                          uint64_t file_size = 0);

/// Returns a file's header, which the rows follow. Offsets follow from the order of the fields.
std::string npy_header(std::span<const NpyField> fields, size_t rows);

}  // namespace frond
