#include "image/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/ranges.h>
#include <malloc.h>

#include <algorithm>
#include <cstring>
#include <future>
#include <mutex>
#include <optional>
#include <system_error>

#include "core/messages/excerpt.h"
#include "openimageio/alpha.h"
#include "openimageio/header_checks.h"
#include "openimageio/webp.h"
#include "system/utf8.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// As OpenImageIO's reader of memory (2.4), without its defect: after a seek beyond the end it reads there.
class MemoryReader final : public OIIO::Filesystem::IOMemReader {
 public:
  explicit MemoryReader(std::string_view bytes)
      : IOMemReader(const_cast<char*>(bytes.data()), bytes.size()) {}  // it only reads

  size_t read(void* to, size_t count) override {
    const size_t done = pread(to, count, m_pos);
    m_pos += int64_t(done);
    return done;
  }
  size_t pread(void* to, size_t count, int64_t offset) override {
    return offset < 0 || uint64_t(offset) >= size() ? 0 : IOMemReader::pread(to, count, offset);
  }
};

/// Returns OpenEXR's attribute `chromaticities`: x and y of red, green, blue and white.
std::optional<Chromaticities> read_chromaticities(const OIIO::ImageSpec& spec) {
  const auto* attribute = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  if (!attribute) return {};
  const auto* v = static_cast<const float*>(attribute->data());
  const auto xy = [v](size_t i) { return Chromaticity{double(v[2 * i]), double(v[2 * i + 1])}; };
  return Chromaticities{xy(0), xy(1), xy(2), xy(3)};
}

/// Returns the text attributes; attributes of other types, and text that is not UTF-8, are ignored.
ImageHeader read_header(const OIIO::ImageSpec& spec) {
  ImageHeader header;
  header.color_space = spec.get_string_attribute(kColorSpaceKey);
  for (const auto& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING && attribute.name() != kColorSpaceKey &&
        is_utf8(attribute.name().string()) && is_utf8(attribute.get_string()))
      header.text[attribute.name().string()] = attribute.get_string();
  return header;
}

/// Returns whether a JPEG's end marker (EOI) follows its last scan (SOS). libjpeg fills missing data with grey and
/// reports success.
bool is_whole_jpeg(std::string_view bytes) {
  const size_t last_scan = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  return last_scan != std::string::npos && end != std::string::npos && end > last_scan;
}

/// Returns whether a PNG (ISO 15948) contains its chunks, each a big-endian length, a type, data and a checksum, up to
/// the last, IEND. OpenImageIO may report success for a file that ends within the pixels, and libpng prints a message.
bool is_whole_png(std::string_view bytes) {
  constexpr size_t kSignature = 8, kType = 4, kAround = 12;  // bytes of a chunk beside its data
  for (size_t at = kSignature; at + kAround <= bytes.size();) {
    size_t length = 0;
    for (size_t i = 0; i < kType; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
    if (bytes.substr(at + kType, kType) == "IEND") return true;
    at += kAround + length;
  }
  return false;
}

/// While one exists, allocated memory is filled with 0, if the C library supports it (glibc). For a damaged file with
/// too few data some decoders return uninitialised memory without an error: pixels would differ from run to run and
/// could contain other data. The memory of other threads is filled too.
class ZeroedMemory {
 public:
  ZeroedMemory() { count(1); }
  ~ZeroedMemory() { count(-1); }
  ZeroedMemory(const ZeroedMemory&) = delete;
  ZeroedMemory& operator=(const ZeroedMemory&) = delete;

 private:
  static void count(int change) {
    static std::mutex mutex;
    static int scopes = 0;
    constexpr int kFillWithZero = 0xff;  // the complement is what allocated memory is filled with
    const std::lock_guard lock(mutex);
    scopes += change;
    mallopt(M_PERTURB, scopes > 0 ? kFillWithZero : 0);
  }
};

/// Reads the pixels into `image`, as floats. Returns false on an error, which OpenImageIO (2.4) may only note. Strips
/// of a TIFF that it would inflate itself, without noting errors, are read row by row.
bool read_pixels(OIIO::ImageInput& in, const OIIO::ImageSpec& spec, Image& image) {
  constexpr auto kFloat = OIIO::TypeDesc::FLOAT;
  constexpr int kAdobeDeflate = 8;
  float* to = image.pixels.data();
  const bool inflates = spec.get_int_attribute("tiff:Compression") == kAdobeDeflate && spec.tile_width == 0 &&
                        spec.get_string_attribute("planarconfig") == "contig";
  if (!inflates) return in.read_image(0, 0, 0, spec.nchannels, kFloat, to) && !in.has_error();
  for (int y = spec.y; y < spec.y + spec.height; ++y, to += size_t(spec.width) * size_t(spec.nchannels))
    if (!in.read_scanlines(0, 0, y, y + 1, 0, 0, spec.nchannels, kFloat, to)) return false;
  return !in.has_error();
}

/// Returns a message that names what a file holds beside its first image: parts of an EXR, pages of a TIFF; nothing
/// where there is none.
std::vector<std::string> left_out_of(OIIO::ImageInput& in, const fs::path& path) {
  constexpr int kMostCounted = 1000;  // each is searched for from the first one on
  constexpr size_t kMostNamed = 5;
  std::vector<std::string> names;
  const auto name = [&in](int part) { return in.spec(part, 0).get_string_attribute("oiio:subimagename"); };
  const std::string first = name(0);
  int others = 0;
  while (others < kMostCounted && in.seek_subimage(others + 1, 0)) {
    ++others;
    if (const std::string other = name(others); !other.empty() && names.size() < kMostNamed)
      names.push_back(fmt::format("\"{}\"", excerpt(other, path)));
  }
  in.geterror();  // after the last one
  if (others == 0) return {};
  const std::string listed =
      names.empty() ? "" : fmt::format(": {}{}", fmt::join(names, ", "), size_t(others) > names.size() ? ", ..." : "");
  return {fmt::format("only the first of the images in \"{}\"{} is read; {}{} left out{}", path.string(),
                      first.empty() ? "" : fmt::format(", \"{}\",", excerpt(first, path)), others,
                      others == kMostCounted ? " or more are"
                      : others == 1          ? " is"
                                             : " are",
                      listed)};
}

/// The codec of this shared object. It has no state, so that all threads can use it at once.
class OpenImageIOCodec final : public ImageCodec {
 public:
  ImageFile decode(std::string_view bytes, std::string_view format, const fs::path& path,
                   const Location& where) const override {
    const ZeroedMemory zeroed;
    std::future<ImageFile> image;
    try {
      // A new thread has no cache of small blocks of memory that were freed before and keep their content.
      image = std::async(std::launch::async, [&] { return decode_here(bytes, format, path, where); });
    } catch (const std::system_error&) {  // the machine has no more threads
      return decode_here(bytes, format, path, where);
    }
    return image.get();
  }

  /// Encodes to memory, because OpenImageIO does not report a full disk.
  std::vector<unsigned char> encode(const fs::path& path, const Image& image,
                                    const std::map<std::string, std::string>& text) const override {
    const auto check = [&path](bool good, const std::string& why) {
      if (!good) fail({}, "cannot encode \"{}\": {}", path.string(), why);
    };
    OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), OIIO::TypeDesc::UINT8);
    spec.channelnames = image.channels;
    spec.attribute("oiio:UnassociatedAlpha", 1);  // no division by alpha in a PNG
    for (const auto& [key, value] : text) spec.attribute(key, value);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto out = OIIO::ImageOutput::create(path.filename().string());
    check(out != nullptr, OIIO::geterror());
    check(out->supports("ioproxy") && out->set_ioproxy(&memory), "OpenImageIO cannot write this format to memory");
    if (std::strcmp(out->format_name(), "jpeg") == 0) spec.attribute("Compression", "jpeg:95");
    check(out->open(path.filename().string(), spec), out->geterror());
    check(out->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()), out->geterror());
    check(out->close(), out->geterror());
    return bytes;
  }

 private:
  /// Calls the reader of one format, and reports its errors with the file's name and the location that refers to it.
  /// Decodes from memory: nothing is opened by name, and a file that changes meanwhile does no harm.
  static ImageFile decode_here(std::string_view bytes, std::string_view format, const fs::path& path,
                               const Location& where) {
    const auto check = [&](bool good, const std::string& why) {
      if (!good) fail(where, "cannot read image \"{}\": {}", path.string(), why.empty() ? "it is damaged" : why);
    };
    const bool is_jpeg = format == "jpeg", is_png = format == "png";
    check((!is_jpeg || is_whole_jpeg(bytes)) && (!is_png || is_whole_png(bytes)), "the file ends too soon");
    const EncodedImage encoded{bytes, path, where};
    check_header(encoded, format);
    if (format == "webp") return decode_webp(encoded);
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);  // keep the file's values: no multiplication by alpha
    MemoryReader memory(bytes);
    try {
      const auto in = OIIO::ImageInput::create(std::string(format));
      check(in != nullptr, OIIO::geterror());
      check(in->set_ioproxy(&memory), "OpenImageIO cannot read this format from memory");
      check(in->open(path.filename().string(), spec, config), in->geterror());
      check_claim(encoded, spec.width, spec.height, spec.nchannels);
      if (const int rows = spec.get_int_attribute("tiff:RowsPerStrip", -1); rows != -1)  // -1: the image is one strip
        check_claim(encoded, spec.width, rows, spec.nchannels);
      check_tiles(encoded, spec.tile_width, spec.tile_height, spec.width, spec.height);
      check(spec.depth == 1 && spec.tile_depth <= 1 && !spec.deep, "it is a volume, or deep");
      ImageFile file{Image(spec.width, spec.height, spec.channelnames), read_header(spec), read_chromaticities(spec),
                     spec.format == OIIO::TypeDesc::UINT8, spec.format == OIIO::TypeDesc::UINT8 || is_png};
      check(read_pixels(*in, spec, file.image), in->geterror());
      if (spec.alpha_channel >= 0 && is_multiplied(encoded, format, spec.get_int_attribute("targa:alpha_type")))
        divide_by_alpha(file.image, size_t(spec.alpha_channel), file.eight_bit);
      file.left_out = left_out_of(*in, path);
      return file;
    } catch (const InputError&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {  // of the libraries that OpenImageIO calls
      fail(where, "cannot read image \"{}\": {}", path.string(), error.what());
    }
  }
};

}  // namespace
}  // namespace frond

const frond::ImageCodecModule* frond_image_codec() {
  static const frond::OpenImageIOCodec codec;
  static const frond::ImageCodecModule module{.codec = &codec};
  return &module;
}
