#pragma once

#include <array>
#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "imports/obj_text.h"

namespace frond {

/// Limits of this process, which reads untrusted files. Each file that is read raises the limits of memory and time in
/// proportion to its size. Memory: 1 GB and 128 times the files, at most the machine's; processor time: 60 s and 2 s
/// for each MB; each file that is read: 4 GB; output: 4 times the memory. No file can be written.
class ProcessLimits {
 public:
  ProcessLimits();
  void allow_file(uint64_t bytes);

 private:
  void apply() const;
  uint64_t memory_, seconds_ = 60, most_memory_;
};

/// The files that the library may open: regular files in the model's folder and below it, through symbolic links too.
/// Files cannot be written. Of OBJ and MTL files the library sees those statements only that the import reads.
class ModelFiles final : public Assimp::IOSystem {
 public:
  ModelFiles(const std::filesystem::path& model, ProcessLimits& limits);

  bool Exists(const char* name) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  /// Compares the model with what the import reads, before the library reads it. Throws std::runtime_error for what it
  /// would misread.
  void check();
  /// Content that changes the look and is not read. To be called after the library has read the files.
  std::vector<ImportedLoss> losses() const { return is_obj_ ? obj_.losses() : gltf_losses_; }
  /// Messages about files that were asked for and not opened.
  const std::vector<std::string>& refusals() const { return refusals_; }
  /// Point that was subtracted from the vertices of an OBJ file (move_obj_to_origin).
  const std::array<double, 3>& origin() const { return origin_; }

 private:
  /// Returns the file's path, or an empty one if it must not be read.
  std::filesystem::path permitted(const char* name, std::string* problem) const;
  void reject(const char* name, const std::string& problem);
  /// Raises the limits by a file, once.
  void allow(const std::filesystem::path& path);
  /// Returns the content of a file, whose name was permitted.
  std::string content(const std::filesystem::path& path);
  /// Returns a file's text for the library, made once.
  const std::string& obj_text(const std::filesystem::path& path);

  std::filesystem::path folder_, model_;
  bool is_obj_;
  ProcessLimits& limits_;
  ObjText obj_;
  std::set<std::filesystem::path> allowed_;
  std::map<std::filesystem::path, std::string> texts_;
  std::vector<ImportedLoss> gltf_losses_;
  std::vector<std::string> refusals_;
  std::array<double, 3> origin_{};
};

}  // namespace frond
