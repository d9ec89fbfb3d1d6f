#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

/// What stands in each row of a NumPy file.
struct NpyField {
  std::string name;           ///< empty: the rows of a plain array
  std::string type;           ///< as NumPy writes it: "<f4"
  std::vector<size_t> shape;  ///< empty: one number
  size_t offset = 0;          ///< bytes from the beginning of a row

  /// How many numbers it has.
  size_t count() const;
  size_t bytes() const;
};

/// How a file that numpy.save wrote is laid out: rows one after another, of the same fields.
struct NpyLayout {
  std::vector<NpyField> fields;
  size_t rows = 0, row_bytes = 0;
  size_t begin = 0;  ///< of the first row in the file
};

/// Throws InputError at `where` for what is no such file, is cut short, or has its columns one after another
/// (fortran_order). Text in the message calls it `name`.
NpyLayout read_npy_layout(std::span<const std::byte> file, std::string_view name, const Location& where);

/// What such a file begins with; its rows follow. Offsets are those that follow from the fields' order.
std::string npy_header(std::span<const NpyField> fields, size_t rows);

}  // namespace frond
