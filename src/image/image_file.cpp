#include "image/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/chrono.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "system/atomic_file.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr const char* kColorSpaceKey = "frond:colorspace";

enum class Format { exr, png, jpeg };

Format format_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return Format::exr;
  if (extension == ".png") return Format::png;
  if (extension == ".jpg" || extension == ".jpeg") return Format::jpeg;
  fail({}, "cannot write \"{}\": images are .exr, .png, .jpg or .jpeg", path.string());
}

std::time_t file_time() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  if (!epoch || !*epoch) return std::time(nullptr);
  const std::string_view text(epoch);
  std::time_t seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  constexpr std::time_t kLastOfYear9999 = 253402300799;
  if (error != std::errc() || end != text.data() + text.size() || seconds < 0 || seconds > kLastOfYear9999)
    fail({}, "SOURCE_DATE_EPOCH is \"{}\", seconds since 1970 are needed", text);
  return seconds;
}

OIIO::ImageSpec make_spec(const Image& image, const ImageHeader& header, Format format, ExrDepth depth) {
  const OIIO::TypeDesc type = format != Format::exr       ? OIIO::TypeDesc::UINT8
                              : depth == ExrDepth::single ? OIIO::TypeDesc::FLOAT
                                                          : OIIO::TypeDesc::HALF;
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), type);
  spec.channelnames = image.channels;
  spec.attribute("oiio:UnassociatedAlpha", 1);  // no division by alpha on the way to a PNG
  for (const auto& [key, value] : header.text) spec.attribute(key, value);
  spec.attribute("DateTime", fmt::format("{:%Y:%m:%d %H:%M:%S}", fmt::gmtime(file_time())));
  if (!header.color_space.empty()) spec.attribute(kColorSpaceKey, header.color_space);
  if (format == Format::exr) {
    if (header.full_width > 0) {
      spec.x = header.x, spec.y = header.y;
      spec.full_width = header.full_width, spec.full_height = header.full_height;
    }
    if (depth == ExrDepth::half && !header.full_precision.empty())
      for (const std::string& name : image.channels) {
        const bool is_full = std::ranges::find(header.full_precision, name) != header.full_precision.end();
        spec.channelformats.push_back(is_full ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF);
      }
    spec.attribute("compression", "zip");
    if (const Chromaticities* c = chromaticities_of(header.color_space)) {
      std::vector<float> xy;
      for (const Chromaticity& p : {c->red, c->green, c->blue, c->white})
        xy.insert(xy.end(), {static_cast<float>(p.x), static_cast<float>(p.y)});
      spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data());
    }
  }
  if (format == Format::jpeg) spec.attribute("Compression", "jpeg:95");
  return spec;
}

/// OpenImageIO does not notice a full disk: it writes to memory.
std::vector<unsigned char> encode(const fs::path& path, const Image& image, const OIIO::ImageSpec& spec) {
  const auto check = [&path](bool good, const std::string& why) {
    if (!good) fail({}, "cannot encode \"{}\": {}", path.string(), why);
  };
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto out = OIIO::ImageOutput::create(path.filename().string());
  check(out != nullptr, OIIO::geterror());
  check(out->supports("ioproxy") && out->set_ioproxy(&memory), "OpenImageIO cannot write this format to memory");
  check(out->open(path.filename().string(), spec), out->geterror());
  check(out->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()), out->geterror());
  check(out->close(), out->geterror());
  return bytes;
}

/// A file of some bytes that claims an image of terabytes is refused before memory is asked for; no compression of
/// pictures does better than this.
void check_size(const OIIO::ImageSpec& spec, uintmax_t file_size, const Location& where, const fs::path& path) {
  constexpr uintmax_t kMostCompression = 4096, kAlwaysAllowed = 64u << 20;
  if (spec.image_bytes(true) > file_size * kMostCompression + kAlwaysAllowed)
    fail(where, "image \"{}\" of {} bytes claims {} x {} pixels of {} channels", path.string(), file_size, spec.width,
         spec.height, spec.nchannels);
}

std::optional<Chromaticities> read_chromaticities(const OIIO::ImageSpec& spec) {
  const auto* attribute = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  if (!attribute) return {};
  const auto* v = static_cast<const float*>(attribute->data());
  const auto xy = [v](size_t i) { return Chromaticity{double(v[2 * i]), double(v[2 * i + 1])}; };
  return Chromaticities{xy(0), xy(1), xy(2), xy(3)};
}

ImageHeader read_header(const OIIO::ImageSpec& spec) {
  ImageHeader header;
  header.color_space = spec.get_string_attribute(kColorSpaceKey);
  for (const auto& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING && attribute.name() != kColorSpaceKey)
      header.text[attribute.name().string()] = attribute.get_string();
  return header;
}

/// libjpeg fills what is missing with grey and reports success: a whole file has its end marker after its last scan.
bool is_whole_jpeg(const std::string& bytes) {
  const size_t last_scan = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  return last_scan != std::string::npos && end != std::string::npos && end > last_scan;
}

/// OpenImageIO can take a PNG for whole that ends in its pixels.
bool is_whole_png(const std::string& bytes) {
  constexpr size_t kAfterName = 8;  // name and checksum
  const size_t end = bytes.rfind("IEND");
  return end != std::string::npos && end + kAfterName <= bytes.size();
}

uintmax_t size_of_file(const fs::path& path, const Location& where) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  if (error) fail(where, "cannot read image \"{}\": {}", path.string(), error.message());
  return size;
}

}  // namespace

bool is_exr(const fs::path& path) { return format_of(path) == Format::exr; }

void check_writable(const fs::path& path) {
  format_of(path);
  file_time();
  check_replaceable(path);
}

void write_image(const fs::path& path, const Image& image, const ImageHeader& header, ExrDepth depth) {
  const Format format = format_of(path);
  const size_t channels = image.channels.size();
  assert(image.pixels.size() == size_t(image.width) * size_t(image.height) * channels);
  if (format == Format::jpeg && channels != 1 && channels != 3)
    fail({}, "cannot write \"{}\": a JPEG has 1 or 3 channels, not {}", path.string(), channels);
  if (format == Format::png && channels > 4)
    fail({}, "cannot write \"{}\": a PNG has 4 channels at most, not {}", path.string(), channels);
  replace_file(path, encode(path, image, make_spec(image, header, format, depth)));
}

ImageFile read_image(const fs::path& path, const Location& where) {
  const uintmax_t file_size = size_of_file(path, where);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto in = OIIO::ImageInput::open(path.string(), &config);
  if (!in) fail(where, "cannot read image \"{}\": {}", path.string(), OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  check_size(spec, file_size, where, path);
  if (spec.depth > 1 || spec.deep) fail(where, "image \"{}\" is a volume, or deep", path.string());
  const bool is_jpeg = std::strcmp(in->format_name(), "jpeg") == 0, is_png = std::strcmp(in->format_name(), "png") == 0;
  if ((is_jpeg && !is_whole_jpeg(read_file_bytes(path, where))) ||
      (is_png && !is_whole_png(read_file_bytes(path, where))))
    fail(where, "cannot read image \"{}\": the file ends too soon", path.string());
  ImageFile file{Image(spec.width, spec.height, spec.channelnames), read_header(spec), read_chromaticities(spec),
                 spec.format == OIIO::TypeDesc::UINT8};
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, file.image.pixels.data()))
    fail(where, "cannot read image \"{}\": {}", path.string(), in->geterror());
  return file;
}

}  // namespace frond
