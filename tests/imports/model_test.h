#pragma once

#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "imports/imported_scene.h"
#include "models/file_source.h"

namespace frond {

/// Files in memory, by name.
class FilesInMemory final : public FileSource {
 public:
  explicit FilesInMemory(std::map<std::string, std::string> files) : files_(std::move(files)) {}
  bool has(const std::string& name) const override { return files_.contains(name); }
  std::string content(const std::string& name) override {
    const auto found = files_.find(name);
    if (found == files_.end()) throw std::runtime_error("there is no such file");
    return found->second;
  }

 private:
  std::map<std::string, std::string> files_;
};

/// Returns the bytes of numbers, one after the other.
template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::vector<std::string> texts_of(const std::vector<ImportedLoss>& losses) {
  std::vector<std::string> texts;
  for (const ImportedLoss& loss : losses) texts.push_back(text_of(loss));
  return texts;
}

/// Returns the message with which `read` refuses a model.
template <class Read>
std::string refusal_by(const Read& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no refusal";
}

}  // namespace frond
