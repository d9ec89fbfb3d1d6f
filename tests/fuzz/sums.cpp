// Files of sums of `frond flux --resume`. The input is the text of the header, NUL, and the arrays: hashes are added
// here.

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
  std::string file = "frond sums 1\n";
  append(file, header.size());
  file += header;
  append(file, hash_bytes(header));
  std::array<std::array<std::byte, 16>, 2> arrays{};
  for (size_t i = 0; i < arrays.size(); ++i) {
    const std::string_view piece = bytes.substr(0, arrays[i].size());
    file += piece;
    append(file, hash_bytes(piece));
    bytes.remove_prefix(piece.size());
  }
  Identity identity;
  identity.add("program", "1");
  identity.add("scene", "2");
  const auto path = fuzz::folder().write("flux.sums", file);
  fuzz::accepts([&] { read_sums(path, identity, {arrays[0], arrays[1]}); });
}
