#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/file_source.h"
#include "models/gltf_json.h"

namespace frond {

/// Bytes and numbers of a glTF file: buffers, buffer views, accessors. Errors are std::runtime_error and begin with the
/// place that the caller gives.
class GltfData {
 public:
  GltfData(const GltfFile& file, FileSource& files) : file_(file), files_(files) {}

  /// Returns the numbers of an accessor, `width` for each of its elements: integers as fractions if they are
  /// normalized, with the values of a sparse accessor. T: float, or uint32_t for indices.
  template <class T>
  std::vector<T> numbers(uint64_t accessor, size_t width, const std::string& place);
  /// Returns the bytes of a buffer view, decompressed, valid as long as this object.
  std::string_view view(uint64_t index, const std::string& place);
  /// Returns the content of a URI with data ("data:image/png;base64,..."), and its media type before it; nothing if the
  /// URI is no such one.
  static std::optional<std::pair<std::string, std::string>> embedded(std::string_view uri);
  /// Returns a URI of a file as a name: percent-encoded, as glTF says, or as it is if there is such a file.
  std::string file_name(std::string_view uri) const;

 private:
  struct Elements;  ///< where an array of elements is
  /// Returns where the elements of an accessor, or of a part of a sparse one, are.
  Elements elements(const nlohmann::json& part, uint64_t component, uint64_t count, size_t width,
                    const std::string& place);
  /// Returns the content of a buffer, read once.
  std::string_view buffer(uint64_t index, const std::string& place);
  /// Returns the bytes of a buffer that an object with buffer, byteOffset and byteLength names.
  std::string_view range(const nlohmann::json& view, const std::string& place);
  /// Returns the bytes that an extension of a buffer view describes.
  std::string decompressed(const nlohmann::json& view, const std::string& place);

  const GltfFile& file_;
  FileSource& files_;
  std::map<uint64_t, std::string> buffers_, views_;  ///< that were read, that were decompressed
};

}  // namespace frond
