// Layout of NumPy files.

#include "scene/geometry/npy.h"

#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(npy, bytes) {
  __extension__ typedef unsigned __int128 Wide;  // products of sizes do not overflow
  NpyLayout layout;
  if (!fuzz::accepts([&] { layout = read_npy_layout(std::as_bytes(std::span(bytes)), "table", {}); })) return;
  fuzz::require(layout.fields.size() <= bytes.size(), "a field takes a byte or more");
  fuzz::require(Wide(layout.begin) + Wide(layout.rows) * layout.row_bytes <= bytes.size(), "rows are inside the file");
  for (const NpyField& field : layout.fields) {
    Wide count = 1;
    for (const size_t n : field.shape) {
      fuzz::require(n == 0 || count <= Wide(SIZE_MAX) / n, "a shape does not overflow");
      count *= n;
    }
    fuzz::require(field.count() == size_t(count), "a field has the count of its shape");
    fuzz::require(Wide(field.offset) + field.bytes() <= layout.row_bytes, "fields are inside the row");
  }
}
