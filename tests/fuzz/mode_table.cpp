// Mode tables of "leaf_solved".

#include "leaf/table/mode_table_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(mode_table, bytes) {
  leaf::ModeTableFile file;
  if (!fuzz::accepts([&] { file = leaf::parse_mode_table_file(bytes, "leaf.modes"); })) return;
  const leaf::ModeTable& table = file.spectrum;
  fuzz::require(table.cells >= 1 && table.cells <= leaf::kMostCells, "cells are in range");
  fuzz::require(!file.columns.empty() && file.columns.size() == table.modes.size(), "each column has modes");
  fuzz::require(table.index.size() == table.modes.size(), "each column has an index");
  fuzz::require_finite(table.index, "an index");
  fuzz::require(std::isfinite(table.error), "the error is finite");
  const auto side = size_t(table.cells) + 3;
  size_t numbers = 0;
  for (const leaf::LeafModes& modes : table.modes) {
    fuzz::require(modes.sines().size() == side, "each node has a sine");
    for (const bool below : {false, true})
      for (const bool crosses : {false, true})
        for (const auto& grid : modes.series(below, crosses)) {
          fuzz::require(grid.size() == side * side, "each pair of nodes has a value");
          fuzz::require_finite(grid, "a value");
          numbers += grid.size();
        }
  }
  fuzz::require(numbers <= 8 * bytes.size(), "a stored number takes a byte or more");
  for (const leaf::ModeTableColumn& column : file.columns)
    fuzz::require_finite(std::array{column.lambda_nm, column.depth}, "a column");
  const std::vector<double> wavelengths = file.wavelengths_nm();
  if (wavelengths.size() == file.columns.size())
    leaf::at_wavelengths(file, {wavelengths.front(), (wavelengths.front() + wavelengths.back()) / 2});
}
