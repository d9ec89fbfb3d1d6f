// Specimen files of leaves.

#include "leaf/tissue/specimen_file.h"

#include "leaf/tissue/leaf_numbers.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(specimen_file, bytes) {
  for (const char* name : {"", "A"})
    fuzz::accepts([&] {
      const leaf::TissueParams leaf = leaf::parse_specimen(bytes, "leaves.csv", name);
      for (const leaf::LeafNumber& n : leaf::leaf_parameters())
        fuzz::require(n.range.contains(n.value(leaf)), "numbers are within their ranges");
    });
}
