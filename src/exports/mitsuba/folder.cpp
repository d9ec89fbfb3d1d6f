#include "exports/mitsuba/folder.h"

#include <fmt/format.h>

#include "core/math/random.h"
#include "image/image_file.h"

namespace frond::mitsuba {
namespace {

uint64_t hash_of(std::span<const unsigned char> bytes, uint64_t seed = 0) {
  return hash_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, seed);
}

/// Bytes of an array.
template <class T>
std::span<const unsigned char> bytes_of(const T* data, size_t count) {
  return {reinterpret_cast<const unsigned char*>(data), count * sizeof(T)};
}

/// Returns the name with only characters that every file system and XML file can hold.
std::string sanitized_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    out += is_plain ? c : '_';
  }
  return out;
}

/// Relative to the folder, as scene.xml names files.
std::string file_name(std::string_view subfolder, std::string_view name, std::string_view extension, uint64_t hash) {
  return fmt::format("{}/{}-{:016x}.{}", subfolder, sanitized_name(name), hash, extension);
}

}  // namespace

/// Fails before any work if scene.xml could not be written.
Folder::Folder(std::filesystem::path path) : path_(path), files_(std::move(path)) { files_.check("scene.xml"); }

/// A file of this name and size has this content.
std::string Folder::add(std::string_view subfolder, std::string_view name, std::string_view extension,
                        std::span<const unsigned char> bytes) {
  std::string relative = file_name(subfolder, name, extension, hash_of(bytes));
  std::error_code error;
  const bool is_there = std::filesystem::file_size(path_ / relative, error) == bytes.size() && !error;
  if (!is_there && !files_.contains(relative)) files_.write(relative, bytes);
  return relative;
}

/// The hash is computed from the pixels.
std::string Folder::add(std::string_view subfolder, std::string_view name, const Image& image) {
  const int size[] = {image.width, image.height};
  const uint64_t hash = hash_of(bytes_of(image.pixels.data(), image.pixels.size()), hash_of(bytes_of(size, 2)));
  std::string relative = file_name(subfolder, name, "exr", hash);
  if (!files_.contains(relative)) files_.write(relative, image_bytes(relative, image, {}));
  return relative;
}

void Folder::finish(const std::string& xml) {
  files_.write("scene.xml", xml);
  files_.finish();
}

}  // namespace frond::mitsuba
