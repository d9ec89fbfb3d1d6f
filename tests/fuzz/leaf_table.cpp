// Leaf tables: CSV of "leaf_simplified".

#include "leaf/table/table_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(leaf_table, bytes) {
  leaf::Table table;
  if (!fuzz::accepts([&] { table = leaf::parse_table(bytes, "leaf.csv"); })) return;
  const size_t cells = table.theta_deg.size() * table.wavelengths_nm.size();
  fuzz::require(cells > 0 && cells <= bytes.size(), "a row takes a byte or more");
  fuzz::require(table.shares.size() == cells, "each angle and wavelength has shares");
  fuzz::require(table.standard_errors.empty() || table.standard_errors.size() == cells, "all shares have errors");
  fuzz::require_finite(table.theta_deg, "an angle");
  fuzz::require_finite(table.wavelengths_nm, "a wavelength");
  fuzz::require(std::isfinite(table.error), "the error is finite");
  for (const leaf::Shares& s : table.shares) {
    fuzz::require_finite(std::array{s.surface, s.subsurface, s.transmitted}, "a share");
    fuzz::require(s.surface >= 0 && s.subsurface >= 0 && s.transmitted >= 0, "shares are not negative");
  }
  for (const leaf::Shares& s : table.standard_errors)
    fuzz::require_finite(std::array{s.surface, s.subsurface, s.transmitted}, "an error");
  const double middle = (table.wavelengths_nm.front() + table.wavelengths_nm.back()) / 2;
  fuzz::accepts([&] { leaf::at_wavelengths(table, {table.wavelengths_nm.front(), middle}); });
  leaf::Table again = leaf::parse_table(leaf::to_csv(table, ""), "again.csv");
  fuzz::require(again.shares == table.shares && again.theta_deg == table.theta_deg, "a written table is read");
}
