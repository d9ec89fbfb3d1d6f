#pragma once

#include <cstdint>
#include <filesystem>
#include <set>

#include "models/file_source.h"

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

/// The files that may be read: regular files in the model's folder and below it, through symbolic links too.
class ModelFiles final : public FileSource {
 public:
  ModelFiles(const std::filesystem::path& model, ProcessLimits& limits);

  bool has(const std::string& name) const override;
  std::string content(const std::string& name) override;

 private:
  std::filesystem::path folder_;
  ProcessLimits& limits_;
  std::set<std::filesystem::path> allowed_;  ///< files that have raised the limits
};

}  // namespace frond
