#include "image/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Throws InputError if the header claims no pixels, or more bytes of floats than the limits, before memory is
/// allocated. Images of 8 bits compress by 1032 at most (deflate).
void check_size(const OIIO::ImageSpec& spec, size_t file_size, const Location& where, const fs::path& path) {
  constexpr uint64_t kMostCompression = 16384, kAlwaysAllowed = 256u << 20, kMostChannels = 1 << 12;
  const auto claim = [&] {
    return fmt::format("image \"{}\" of {} bytes claims {} x {} pixels of {} channels", path.string(), file_size,
                       spec.width, spec.height, spec.nchannels);
  };
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth <= 0) fail(where, "{}", claim());
  if (uint64_t(spec.nchannels) > kMostChannels) fail(where, "{}: {} channels are the limit", claim(), kMostChannels);
  constexpr int kRowsAtOnce = 64;  // for which OpenImageIO allocates memory even where there are fewer
  const uint64_t pixels = uint64_t(spec.width) * uint64_t(std::max(spec.height, kRowsAtOnce));  // both below 2^31
  const uint64_t most = file_size * kMostCompression + kAlwaysAllowed;
  if (pixels > most / (uint64_t(spec.nchannels) * sizeof(float))) fail(where, "{}", claim());
}

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

/// Returns the text attributes; those of other types are ignored.
ImageHeader read_header(const OIIO::ImageSpec& spec) {
  ImageHeader header;
  header.color_space = spec.get_string_attribute(kColorSpaceKey);
  for (const auto& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING && attribute.name() != kColorSpaceKey)
      header.text[attribute.name().string()] = attribute.get_string();
  return header;
}

/// Returns whether a JPEG's end marker (EOI) follows its last scan (SOS). libjpeg fills missing data with grey and
/// reports success.
bool is_whole_jpeg(std::string_view bytes) {
  const size_t last_scan = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  return last_scan != std::string::npos && end != std::string::npos && end > last_scan;
}

/// Returns whether a PNG contains its last chunk, IEND. OpenImageIO may report success for a file that ends within the
/// pixels.
bool is_whole_png(std::string_view bytes) {
  constexpr size_t kAfterName = 8;  // name and checksum of the chunk, 4 bytes each
  const size_t end = bytes.rfind("IEND");
  return end != std::string::npos && end + kAfterName <= bytes.size();
}

/// Throws InputError if an attribute of an EXR's headers claims more bytes than follow, for which OpenEXR would
/// allocate memory (OpenEXR File Layout). Other damage is left to OpenEXR.
void check_exr_header(std::string_view bytes, const Location& where, const fs::path& path) {
  constexpr size_t kVersion = 4, kAttributes = 8;
  if (bytes.size() < kAttributes) return;
  const bool has_parts = (bytes[kVersion + 1] & 0x10) != 0;
  std::string_view rest = bytes.substr(kAttributes);
  const auto take_text = [&rest]() -> std::optional<std::string_view> {
    const size_t end = rest.find('\0');
    if (end == rest.npos) return {};
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return text;
  };
  for (;;) {
    const auto name = take_text();
    if (!name) return;
    if (name->empty()) {
      if (!has_parts || rest.empty() || rest.front() == '\0') return;
      continue;
    }
    int32_t size = 0;
    if (!take_text() || rest.size() < sizeof size) return;
    std::memcpy(&size, rest.data(), sizeof size);
    rest.remove_prefix(sizeof size);
    if (size < 0 || size_t(size) > rest.size())
      fail(where, "cannot read image \"{}\": an attribute of its header claims {} bytes, {} follow", path.string(),
           size, rest.size());
    rest.remove_prefix(size_t(size));
  }
}

/// The codec of this shared object. It has no state, so that all threads can use it at once.
class OpenImageIOCodec final : public ImageCodec {
 public:
  /// Calls the reader of one format, and passes its errors on with the name of the file and the place that asks for it.
  /// Decodes from memory: nothing is opened by name, and a file that changes meanwhile does no harm.
  ImageFile decode(std::string_view bytes, std::string_view format, const fs::path& path,
                   const Location& where) const override {
    const auto check = [&](bool good, const std::string& why) {
      if (!good) fail(where, "cannot read image \"{}\": {}", path.string(), why.empty() ? "it is damaged" : why);
    };
    const bool is_jpeg = format == "jpeg", is_png = format == "png";
    check((!is_jpeg || is_whole_jpeg(bytes)) && (!is_png || is_whole_png(bytes)), "the file ends too soon");
    if (format == "openexr") check_exr_header(bytes, where, path);
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);  // keep the file's values: no multiplication by alpha
    MemoryReader memory(bytes);
    try {
      const auto in = OIIO::ImageInput::create(std::string(format));
      check(in != nullptr, OIIO::geterror());
      check(in->set_ioproxy(&memory), "OpenImageIO cannot read this format from memory");
      check(in->open(path.filename().string(), spec, config), in->geterror());
      check_size(spec, bytes.size(), where, path);
      check(spec.depth == 1 && !spec.deep, "it is a volume, or deep");
      ImageFile file{Image(spec.width, spec.height, spec.channelnames), read_header(spec), read_chromaticities(spec),
                     spec.format == OIIO::TypeDesc::UINT8, spec.format == OIIO::TypeDesc::UINT8 || is_png};
      check(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, file.image.pixels.data()), in->geterror());
      return file;
    } catch (const InputError&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {  // of the libraries that OpenImageIO calls
      fail(where, "cannot read image \"{}\": {}", path.string(), error.what());
    }
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
};

}  // namespace
}  // namespace frond

const frond::ImageCodecModule* frond_image_codec() {
  static const frond::OpenImageIOCodec codec;
  static const frond::ImageCodecModule module{.codec = &codec};
  return &module;
}
