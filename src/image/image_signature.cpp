#include "image/image_signature.h"

#include <algorithm>
#include <array>

namespace frond {
namespace {

using namespace std::string_view_literals;

/// Bytes at an offset by which a format is recognised.
struct Signature {
  std::string_view format;
  std::string_view bytes;
  size_t offset = 0;
};

/// Formats that are read, by OpenImageIO's names.
constexpr Signature kRead[] = {{"openexr", "\x76\x2f\x31\x01"sv},
                               {"png", "\x89PNG\r\n\x1a\n"sv},
                               {"jpeg", "\xff\xd8\xff"sv},
                               {"hdr", "#?"sv},
                               {"tiff", "II*\0"sv},
                               {"tiff", "MM\0*"sv},
                               {"tiff", "II+\0"sv},
                               {"tiff", "MM\0+"sv},
                               {"webp", "WEBP"sv, 8}};

/// Formats that are refused by name.
constexpr Signature kRefused[] = {{"GIF", "GIF8"sv},
                                  {"DPX", "SDPX"sv},
                                  {"DPX", "XPDS"sv},
                                  {"Cineon", "\x80\x2a\x5f\xd7"sv},
                                  {"IFF", "FOR4"sv},
                                  {"IFF", "FORM"sv},
                                  {"Photoshop", "8BPS"sv},
                                  {"DirectDraw surface", "DDS "sv},
                                  {"icon", "\0\0\1\0"sv},
                                  {"FITS", "SIMPLE"sv},
                                  {"SGI", "\x01\xda"sv},
                                  {"QOI", "qoif"sv},
                                  {"JPEG 2000", "\0\0\0\x0cjP"sv},
                                  {"JPEG 2000", "\xff\x4f\xff\x51"sv},
                                  {"JPEG XL", "\xff\x0a"sv},
                                  {"JPEG XL", "\0\0\0\x0cJXL"sv},
                                  {"HEIF, AVIF or MP4", "ftyp"sv, 4},
                                  {"AVI", "AVI "sv, 8},
                                  {"Matroska or WebM", "\x1a\x45\xdf\xa3"sv},
                                  {"SVG or another XML", "<"sv},
                                  {"playlist", "#EXTM3U"sv},
                                  {"Softimage", "\x53\x80\xf6\x34"sv},
                                  {"zfile", "\x2f\x08\x67\xab"sv},
                                  {"PDF", "%PDF"sv},
                                  {"gzip", "\x1f\x8b"sv}};

bool matches_signature(std::string_view bytes, const Signature& s) {
  return bytes.size() >= s.offset && bytes.substr(s.offset).starts_with(s.bytes);
}

unsigned byte_at(std::string_view bytes, size_t i) { return static_cast<unsigned char>(bytes[i]); }
unsigned word_at(std::string_view bytes, size_t i) { return byte_at(bytes, i) | byte_at(bytes, i + 1) << 8; }

template <size_t N>
bool is_one_of(unsigned value, const std::array<unsigned, N>& values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// "PF" or "Pf" and white space; P1 to P6 are Netpbm's other formats.
bool is_pfm(std::string_view bytes) {
  return bytes.size() > 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         " \t\r\n"sv.find(bytes[2]) != std::string_view::npos;
}
bool is_netpbm(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7';
}

/// "BM" is a short signature: the size of the header that follows must be one of those that exist.
bool is_bmp(std::string_view bytes) {
  constexpr size_t kHeader = 14, kSizeField = 4;
  constexpr std::array kSizes{12u, 40u, 52u, 56u, 64u, 108u, 124u};
  return bytes.size() >= kHeader + kSizeField && bytes.starts_with("BM") &&
         is_one_of(word_at(bytes, kHeader), kSizes) && word_at(bytes, kHeader + 2) == 0;
}

/// The header of a TGA (Truevision TGA File Format Specification 2.0): types of image and of colour map, bits of a
/// pixel, a size that is not empty, reserved bits that are 0.
bool is_tga(std::string_view bytes, const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  constexpr size_t kHeader = 18;
  if (extension != ".tga" || bytes.size() <= kHeader) return false;
  const unsigned map = byte_at(bytes, 1), type = byte_at(bytes, 2), map_bits = byte_at(bytes, 7),
                 bits = byte_at(bytes, 16), descriptor = byte_at(bytes, 17);
  const bool mapped = type == 1 || type == 9;
  return is_one_of(type, std::array{1u, 2u, 3u, 9u, 10u, 11u}) && map == (mapped ? 1u : 0u) &&
         (mapped ? bits == 8 && is_one_of(map_bits, std::array{15u, 16u, 24u, 32u})
                 : is_one_of(bits, std::array{8u, 15u, 16u, 24u, 32u})) &&
         word_at(bytes, 12) > 0 && word_at(bytes, 14) > 0 && (descriptor & 0xc0) == 0;
}

}  // namespace

std::string_view image_format_of(std::string_view bytes, const std::filesystem::path& path, const Location& where) {
  for (const Signature& s : kRead)
    if (matches_signature(bytes, s) && (s.format != "webp" || bytes.starts_with("RIFF"))) return s.format;
  if (is_pfm(bytes)) return "pnm";
  if (is_bmp(bytes)) return "bmp";
  if (is_tga(bytes, path)) return "targa";
  constexpr std::string_view kFormats = "images are EXR, PNG, JPEG, HDR, TIFF, PFM, BMP, WebP or TGA";
  if (bytes.empty()) fail(where, "cannot read image \"{}\": the file is empty", path.string());
  if (is_netpbm(bytes)) fail(where, "cannot read image \"{}\": its format is Netpbm; {}", path.string(), kFormats);
  for (const Signature& s : kRefused)
    if (matches_signature(bytes, s))
      fail(where, "cannot read image \"{}\": its format is {}; {}", path.string(), s.format, kFormats);
  fail(where, "cannot read image \"{}\": its content is that of no image; {}", path.string(), kFormats);
}

}  // namespace frond
