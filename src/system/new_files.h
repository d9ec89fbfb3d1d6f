#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Files of one folder that appear together or not at all. They are written into a temporary folder, on the same disk,
/// and get their names at the end. If the process is killed before that, nothing is there but the temporary folder,
/// which the next command that writes there deletes. All functions throw InputError.
class NewFiles {
 public:
  /// The files will be below `folder`, which need not exist. No file replaces one of `inputs`.
  explicit NewFiles(std::filesystem::path folder, std::vector<std::filesystem::path> inputs = {});
  /// Deletes the files unless `finish` has returned.
  ~NewFiles();
  NewFiles(const NewFiles&) = delete;
  NewFiles& operator=(const NewFiles&) = delete;

  /// Throws InputError if the file `name` cannot be created: a folder has this name, or a file has the name of its
  /// folder.
  void check(const std::string& name) const;
  /// Returns the temporary path of the file `name`, relative to the folder, for writing before `finish`.
  std::filesystem::path file(const std::string& name);
  /// Returns the temporary path of a folder, which is created.
  std::filesystem::path folder(const std::string& name);
  /// Whether `file` or `write` has been called for this name.
  bool contains(const std::string& name) const { return known_.contains(name); }
  void write(const std::string& name, std::span<const unsigned char> bytes);
  void write(const std::string& name, std::string_view text);
  /// Gives the files their names, in the order of `file` and `write`: the last is there only when all are. If one
  /// cannot have its name, files that have been replaced and folders are as before.
  void finish();

 private:
  struct Placed {
    std::filesystem::path target, old;  ///< `old`: the file that was replaced, or ""
  };
  void make_folder(const std::filesystem::path& folder);
  void move_into_place(const std::filesystem::path& from, const std::filesystem::path& target);
  void roll_back();

  std::filesystem::path folder_, temporary_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> names_;  ///< of files, in the order in which they appear
  std::set<std::string> known_;     ///< the same
  std::vector<std::string> folders_;
  std::vector<std::filesystem::path> made_;  ///< folders that `finish` has created
  std::vector<Placed> placed_;
  int lock_ = -1;
};

}  // namespace frond
