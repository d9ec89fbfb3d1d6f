#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <thread>

#include "imports/scene_stream.h"
#include "models/gltf_reader.h"
#include "models/model_files.h"
#include "models/obj_reader.h"
#include "system/lower_case.h"

// Program that reads a model file, OBJ or glTF, in a process of its own with limits, and writes it as plain data to
// standard output. `frond import` starts it (imports/model_reader.h).

namespace frond {
namespace {

/// Reads a model by the format that its name states.
ImportedScene read(const std::filesystem::path& model) {
  ProcessLimits limits;
  ModelFiles files(model, limits);
  const std::string name = model.filename().string(), bytes = files.content(name);
  return lower_case(model.extension().string()) == ".obj" ? read_obj(bytes, name, files) : read_gltf(bytes, files);
}

/// Ends this process when frond ends, killed or not: standard input is a pipe that frond holds open and never writes
/// to.
void end_with_parent() {
  std::thread([] {
    char byte = 0;
    ssize_t n = 0;
    do n = ::read(STDIN_FILENO, &byte, 1);
    while (n > 0 || (n < 0 && errno == EINTR));
    _exit(1);
  }).detach();
}

}  // namespace
}  // namespace frond

/// Exit code 0: the scene is on standard output. 1: the reason is on standard error.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: frond-model-reader MODEL (started by frond import)\n", stderr);
    return 2;
  }
  frond::end_with_parent();
  try {
    const std::string bytes = frond::encode(frond::read(argv[1]));
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0) return 0;
    std::fputs("its result cannot be stored in a temporary file", stderr);
  } catch (const std::bad_alloc&) {
    std::fputs("it needs more memory than 1 GB and 128 times the size of its files", stderr);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
  }
  return 1;
}
