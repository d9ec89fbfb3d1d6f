#include "exports/mitsuba/folder.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "image/image_file.h"
#include "system/atomic_file.h"

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
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    out += is_plain ? c : '_';
  }
  return out;
}

/// Relative to the folder, as scene.xml names files.
std::string file_name(std::string_view subfolder, std::string_view name, std::string_view extension, uint64_t hash) {
  return fmt::format("{}/{}-{:016x}.{}", subfolder, plain(name), hash, extension);
}

}  // namespace

/// Fails before any work if scene.xml could not be written.
Folder::Folder(std::filesystem::path path) : path_(std::move(path)) {
  make_folders(path_);
  check_replaceable(path_ / "scene.xml");
}

/// A file of this name and size has this content.
std::string Folder::add(std::string_view subfolder, std::string_view name, std::string_view extension,
                        std::span<const unsigned char> bytes) {
  const std::string relative = file_name(subfolder, name, extension, hash_of(bytes));
  const std::filesystem::path path = path_ / relative;
  std::error_code error;
  if (std::filesystem::file_size(path, error) == bytes.size() && !error) return relative;
  make_folders(path.parent_path());
  replace_file(path, bytes);
  return relative;
}

/// The hash is that of the pixels.
std::string Folder::add(std::string_view subfolder, std::string_view name, const Image& image) {
  const int size[] = {image.width, image.height};
  const uint64_t hash = hash_of(bytes_of(image.pixels.data(), image.pixels.size()), hash_of(bytes_of(size, 2)));
  const std::string relative = file_name(subfolder, name, "exr", hash);
  make_folders((path_ / relative).parent_path());
  write_image(path_ / relative, image, {});
  return relative;
}

void Folder::finish(const std::string& xml) { replace_file(path_ / "scene.xml", bytes_of(xml.data(), xml.size())); }

}  // namespace frond::mitsuba
