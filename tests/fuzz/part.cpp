// Part files. The input is the text of the header, NUL, and the sums: hashes and compression are added here, so that
// changes of the input reach the reader.

#include <zstd.h>

#include "core/math/random.h"
#include "render/film/image_format.h"
#include "render/parts/part_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void append(std::string& to, uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

static std::string part_of(std::string_view header, std::string_view sums) {
  std::string bytes = "frond part 4\n";
  append(bytes, header.size());
  bytes += header;
  append(bytes, hash_bytes(header));
  std::string packed(ZSTD_compressBound(sums.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), sums.data(), sums.size(), 1));
  return bytes + packed + "frond part end\n";
}

static void check(const RenderPart& part) {
  const Crop& crop = part.film.settings().crop;
  fuzz::require(crop.width() > 0 && crop.height() > 0, "a film has pixels");
  sample_count(part.film), missing_samples_text(part), lacks_neighboring_samples(part.film);
  film_image(part.film, part.header.image);
  finished_format(part);
}

FROND_FUZZ_TARGET(part, bytes) {
  const std::string_view header = fuzz::take_part(bytes);
  const std::string file = part_of(header, bytes);
  const auto path = fuzz::folder().write("film.part", file);
  fuzz::accepts([&] { read_part_head(path); });
  fuzz::accepts([&] {
    const RenderPart part = decode_part(file, path);
    check(part);
    const auto again = encode_part(part.header, part.film);
    const RenderPart same = decode_part({reinterpret_cast<const char*>(again.data()), again.size()}, path);
    fuzz::require(encode_part(same.header, same.film) == again, "a written part is read");
  });
  fuzz::accepts([&] { merge_parts({path}); });
}
