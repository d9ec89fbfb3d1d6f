#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Returns the message of the InputError that `act` throws; "" if it throws none. Other exceptions pass through.
template <class Act>
std::string error_of(const Act& act) {
  try {
    act();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// A folder for the files of one test, gone with it.
class TestFolder {
 public:
  explicit TestFolder(std::string_view name) : path_(std::filesystem::temp_directory_path() / unique(name)) {
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view text) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string name_of(const std::string& file) const { return (path_ / file).string(); }

 private:
  std::string unique(std::string_view name) const {
    return fmt::format("frond_{}_{}_{}", name, ::getpid(), fmt::ptr(this));
  }
  std::filesystem::path path_;
};

}  // namespace frond
