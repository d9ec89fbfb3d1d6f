#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

/// Files that a job reads and writes: no output may be an input or another output.
namespace frond {

/// Whether both paths name one file: the same device and inode, as hard and symbolic links have, or, for files that do
/// not exist, the same name in the same folder.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws InputError at `where` for a name that begins with "-", except "-" itself: it is likely an option. The message
/// starts with `what`, the name of the parameter.
void check_file_name(std::string_view path, std::string_view what, const Location& where = {});

/// The files of one job: those that its thread, and threads that belong to no job, read while it exists, and its
/// planned outputs.
class FileUses {
 public:
  FileUses();
  ~FileUses();
  FileUses(const FileUses&) = delete;
  FileUses& operator=(const FileUses&) = delete;

 private:
  FileUses* outer_;  ///< of this thread
};

/// A file that the running job will write; without a FileUses it has no effect.
class PlannedOutput {
 public:
  /// `name` is the parameter's name, for messages. Throws InputError at `where` if the job has read the file or will
  /// write it under another name. "-" is standard output.
  PlannedOutput(std::string name, std::string path, const Location& where = {});
  ~PlannedOutput();
  PlannedOutput(const PlannedOutput&) = delete;
  PlannedOutput& operator=(const PlannedOutput&) = delete;

 private:
  FileUses* job_;
};

/// Notes that a file is read. Throws InputError at `where` if it is a planned output: the job would replace its input.
void record_read(const std::filesystem::path& path, const Location& where);
/// Allows reading a planned output: a job resumes from its own result.
void allow_reading(const std::filesystem::path& output);

}  // namespace frond
