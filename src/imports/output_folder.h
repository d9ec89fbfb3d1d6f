#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace frond {

/// Files that appear together: they are written into a temporary folder beside their place, and renamed at the end.
/// All functions throw InputError.
class OutputFolder {
 public:
  /// The files will be in `folder`, which must exist. `inputs` are never replaced.
  OutputFolder(std::filesystem::path folder, std::vector<std::filesystem::path> inputs);
  /// Deletes the temporary folder.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Returns the temporary path of the file `name`, relative to the folder, for writing.
  std::filesystem::path file(const std::string& name);
  void write(const std::string& name, std::span<const unsigned char> bytes);
  void write(const std::string& name, const std::string& text);
  /// Renames the files in the order of their names' declaration, so that the last is there when all are.
  void finish();

 private:
  std::filesystem::path folder_, temporary_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> names_;
};

}  // namespace frond
