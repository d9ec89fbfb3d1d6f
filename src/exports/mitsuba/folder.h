#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"
#include "system/new_files.h"

namespace frond::mitsuba {

/// Folder of an export. Meshes and textures are files whose names contain a hash of their content. All files appear
/// together, scene.xml last: an export that fails leaves the folder as it was.
class Folder {
 public:
  /// Throws InputError if the folder cannot be created or written.
  explicit Folder(std::filesystem::path path);

  /// Writes a file NAME-HASH.EXTENSION into a subfolder, unless it exists with this content. Returns its path relative
  /// to the folder.
  std::string add(std::string_view subfolder, std::string_view name, std::string_view extension,
                  std::span<const unsigned char> bytes);
  /// The same for an image, as EXR with 32-bit floats.
  std::string add(std::string_view subfolder, std::string_view name, const Image& image);
  /// Writes scene.xml, with which all files appear.
  void finish(const std::string& xml);

 private:
  std::filesystem::path path_;
  NewFiles files_;
};

}  // namespace frond::mitsuba
