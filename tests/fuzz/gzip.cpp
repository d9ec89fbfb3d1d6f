// Decompression of scenes and meshes.

#include "system/gzip.h"

#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(gzip, bytes) {
  constexpr size_t kMost = size_t{1} << 20;
  fuzz::accepts([&] { fuzz::require(unpack_gzip(bytes, "file.gz", {}, kMost).size() <= kMost, "the limit is kept"); });
}
