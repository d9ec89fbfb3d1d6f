// Spectral libraries of ENVI: the header, a vertical tab, and the data.

#include "spectra/envi_library.h"

#include "spectra/spectra_text.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(envi_library, bytes) {
  const size_t end = std::min(bytes.find('\v'), bytes.size());
  std::string table;
  const std::string data(bytes.substr(std::min(end + 1, bytes.size())));
  if (!fuzz::accepts([&] { table = envi_library_table(bytes.substr(0, end), data, {}); })) return;
  fuzz::require(table.size() <= 400 + 200 * bytes.size(), "a table is not much larger than its library");
  spectra_text(table);
}
