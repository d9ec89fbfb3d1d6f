#pragma once

#include <string>

namespace frond {

/// Files that a model names. Names are paths relative to the model's folder; separators of Windows are accepted.
class FileSource {
 public:
  virtual ~FileSource() = default;
  /// Whether a file can be read.
  virtual bool has(const std::string& name) const = 0;
  /// Returns a file's content. Throws std::runtime_error with the reason if it must not or cannot be read.
  virtual std::string content(const std::string& name) = 0;
};

}  // namespace frond
