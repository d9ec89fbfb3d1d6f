// Files of sums of `frond flux`. The input is the text of the header of one part, NUL, and two arrays of 16 bytes:
// hashes are added here.

#include <cstring>

#include "core/math/random.h"
#include "radiometry/sums_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void append(std::string& to, uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

FROND_FUZZ_TARGET(sums, bytes) {
  constexpr size_t kArrayBytes = 16;
  const std::string_view header = fuzz::take_part(bytes);
  std::string file = "frond sums 2\n";
  append(file, 1);
  append(file, header.size());
  file += header;
  append(file, hash_bytes(header));
  for (int i = 0; i < 2; ++i) {
    const std::string_view piece = bytes.substr(0, kArrayBytes);
    file += piece;
    append(file, hash_bytes(piece));
    bytes.remove_prefix(piece.size());
  }
  const auto path = fuzz::folder().write("flux.sums", file);
  fuzz::accepts([&] { read_sums(path); });
}
