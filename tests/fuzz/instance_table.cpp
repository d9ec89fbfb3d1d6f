// Instance tables: NumPy files as Shape "instances" reads them.

#include "scene/geometry/instance_table.h"

#include "scene/geometry/npy.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(instance_table, bytes) {
  static const ThreadPool pool(1);
  const auto path = fuzz::folder().write("table.npy", bytes);
  std::unique_ptr<InstanceTable> table;
  if (!fuzz::accepts([&] { table = std::make_unique<InstanceTable>(path, Location{}, pool); })) return;
  const NpyLayout layout = read_npy_layout(std::as_bytes(std::span(bytes)), "table", {});
  fuzz::require(table->size() == layout.rows, "the table has the file's rows");
  fuzz::require(table->size() * sizeof(AffineMap) <= bytes.size(), "each row has 12 numbers");
  for (size_t row = 0; row < table->size(); ++row) {
    fuzz::require(size_t(table->bytes(row) - table->bytes(0)) == row * layout.row_bytes, "rows are consecutive");
    for (const auto& numbers : table->map(row).rows) fuzz::require_finite(numbers, "a map");
    for (const InstanceColumn& column : table->columns()) {
      fuzz::require(column.offset + sizeof(float) <= layout.row_bytes, "columns are inside the row");
      float value;
      std::memcpy(&value, table->bytes(row) + column.offset, sizeof value);
      fuzz::require(!(double(value) < column.range.min) && !(double(value) > column.range.max),
                    "values are in the column's range");
    }
  }
}
