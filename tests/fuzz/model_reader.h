#pragma once

#include <stdexcept>

#include "imports/scene_stream.h"
#include "models/file_source.h"
#include "tests/fuzz/fuzz.h"

namespace frond::fuzz {

/// Files with the same content, of all names with an even number of bytes.
class OneFile final : public FileSource {
 public:
  explicit OneFile(std::string_view bytes) : bytes_(bytes) {}
  bool has(const std::string& name) const override { return name.size() % 2 == 0; }
  std::string content(const std::string& name) override {
    if (!has(name)) throw std::runtime_error("there is no such file");
    return std::string(bytes_);
  }

 private:
  std::string_view bytes_;
};

/// Reads a model by `read`: a refusal has a message, and a scene passes the checks of the process that receives it, or
/// has values that are not finite.
template <class Read>
void check_model(const Read& read) {
  std::string bytes, problem;
  try {
    const ImportedScene scene = read();
    for (const ImportedLoss& loss : scene.losses) require(!text_of(loss).empty(), "a loss has a text");
    bytes = encode(scene);
  } catch (const std::runtime_error& error) {
    require(!std::string_view(error.what()).empty(), "a refusal has a message");
    return;
  }
  try {
    require(encode(decode(bytes)) == bytes, "a scene is received as it was sent");
  } catch (const std::runtime_error& error) {
    require(std::string_view(error.what()).find("not finite") != std::string_view::npos, error.what());
  }
}

}  // namespace frond::fuzz
