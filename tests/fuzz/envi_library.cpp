// Spectral libraries of ENVI: the header, NUL, and the data.

#include "spectra/envi_library.h"

#include "spectra/spectra_text.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(envi_library, bytes) {
  std::string table;
  const size_t size = bytes.size();
  const std::string_view header = fuzz::take_part(bytes);
  if (!fuzz::accepts([&] { table = envi_library_table(header, bytes, {}); })) return;
  fuzz::require(table.size() <= 400 + 200 * size, "a table is not much larger than its library");
  spectra_text(table);
}
