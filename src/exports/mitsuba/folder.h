#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"

namespace frond::mitsuba {

/// Folder of an export. Meshes and textures are files whose names contain a hash of their content, and scene.xml is
/// written last: an interrupted export leaves an older scene.xml and its files as they were.
class Folder {
 public:
  /// Creates the folder if it does not exist. Throws InputError if it cannot be written.
  explicit Folder(std::filesystem::path path);

  /// Writes a file NAME-HASH.EXTENSION into a subfolder, unless it exists with this content. Returns its path relative
  /// to the folder.
  std::string add(std::string_view subfolder, std::string_view name, std::string_view extension,
                  std::span<const unsigned char> bytes);
  /// The same for an image, as EXR with 32-bit floats.
  std::string add(std::string_view subfolder, std::string_view name, const Image& image);
  /// Writes scene.xml.
  void finish(const std::string& xml);

 private:
  std::filesystem::path path_;
};

}  // namespace frond::mitsuba
