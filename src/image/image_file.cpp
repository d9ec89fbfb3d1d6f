#include "image/image_file.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <cassert>
#include <cerrno>

#include "image/exr.h"
#include "image/image_codec.h"
#include "image/image_signature.h"
#include "system/atomic_file.h"
#include "system/file_bytes.h"
#include "system/file_time.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

enum class Format { exr, png, jpeg };

Format format_of(const fs::path& path, const Location& where = {}) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return Format::exr;
  if (extension == ".png") return Format::png;
  if (extension == ".jpg" || extension == ".jpeg") return Format::jpeg;
  fail(where, "cannot write \"{}\": images are .exr, .png, .jpg or .jpeg", path.string());
}

}  // namespace

void check_image_name(const fs::path& path, const Location& where) { (void)format_of(path, where); }

bool is_exr(const fs::path& path) { return format_of(path) == Format::exr; }

void check_writable(const fs::path& path) {
  if (format_of(path) != Format::exr) image_codec();
  file_time();
  check_replaceable(path);
}

std::vector<unsigned char> image_bytes(const fs::path& path, const Image& image, const ImageHeader& header,
                                       ExrDepth depth) {
  const Format format = format_of(path);
  const size_t channels = image.channels.size();
  assert(image.pixels.size() == size_t(image.width) * size_t(image.height) * channels);
  if (format == Format::jpeg && channels != 1 && channels != 3)
    fail({}, "cannot write \"{}\": a JPEG has 1 or 3 channels, not {}", path.string(), channels);
  if (format == Format::png && channels > 4)
    fail({}, "cannot write \"{}\": a PNG has 4 channels at most, not {}", path.string(), channels);
  ImageHeader complete = header;
  if (!header.color_space.empty()) complete.text[kColorSpaceKey] = header.color_space;
  const std::string date = fmt::format("{:%Y:%m:%d %H:%M:%S}", fmt::gmtime(file_time()));
  complete.text[format == Format::exr ? "capDate" : "DateTime"] = date;
  return format == Format::exr ? encode_exr(image, complete, depth) : image_codec().encode(path, image, complete.text);
}

void write_image(const fs::path& path, const Image& image, const ImageHeader& header, ExrDepth depth) {
  replace_file(path, image_bytes(path, image, header, depth));
}

ImageFile read_image(const fs::path& path, const Location& where) {
  const std::string bytes = read_file_bytes(path, where, "image");
  return image_codec().decode(bytes, image_format_of(bytes, path, where), path, where);
}

}  // namespace frond
