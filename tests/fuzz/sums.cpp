// Files of sums of `frond flux --resume` and `--merge`, with one part. The input is the text of the header, NUL, and
// two arrays of 16 bytes: hashes are added here.

#include <cstring>

#include "core/math/random.h"
#include "radiometry/sums_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void append(std::string& to, uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

FROND_FUZZ_TARGET(sums, bytes) {
  const std::string_view header = fuzz::take_part(bytes);
  std::string file = "frond sums 3\n";
  append(file, 1);
  append(file, header.size());
  file += header;
  append(file, hash_bytes(header));
  constexpr size_t kArrays = 2, kBytes = 16;
  for (size_t i = 0; i < kArrays; ++i) {
    const std::string_view piece = bytes.substr(0, kBytes);
    file += piece;
    append(file, hash_bytes(piece));
    bytes.remove_prefix(piece.size());
  }
  const auto path = fuzz::folder().write("flux.sums", file);
  fuzz::accepts([&] { (void)read_sums(path); });
}
