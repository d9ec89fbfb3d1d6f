#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace frond {

/// Files that appear together, or not at all: they are written into a temporary folder beside their place, and renamed
/// at the end. All functions throw InputError.
class OutputFolder {
 public:
  /// The files will be in `folder`, which must exist. `inputs` are never replaced. Deletes what killed processes have
  /// left in the folder.
  OutputFolder(std::filesystem::path folder, std::vector<std::filesystem::path> inputs);
  /// Deletes the temporary folder.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Returns the temporary path of the file `name`, relative to the folder, for writing.
  std::filesystem::path file(const std::string& name);
  void write(const std::string& name, std::span<const unsigned char> bytes);
  void write(const std::string& name, const std::string& text);
  /// Renames the files in the order of their names' declaration, so that the last is there when all are. If one cannot
  /// be renamed, the folder is as it was before.
  void finish();

 private:
  /// What `finish` has done to a file.
  struct Placed {
    std::filesystem::path target, old;  ///< file that was there before, in the temporary folder; empty: none
  };
  void place(const std::string& name);
  /// Undoes what `finish` has done.
  void restore() noexcept;

  std::filesystem::path folder_, temporary_;
  int lock_ = -1;  ///< of the temporary folder, while this process writes it
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> names_;
  std::vector<Placed> placed_;
  std::vector<std::filesystem::path> made_;  ///< folders
};

}  // namespace frond
