#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "assimp/model_files.h"
#include "assimp/scene_conversion.h"
#include "imports/scene_stream.h"

// Program that reads a model file with the library assimp, in a process of its own with limits, and writes it as
// plain data to standard output. `frond import` starts it (imports/model_reader.h).

namespace frond {
namespace {

/// Removes all readers except for OBJ and glTF: a file could otherwise select any of some fifty.
void keep_readers(Assimp::Importer& importer) {
  for (size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string extensions = importer.GetImporterInfo(i)->mFileExtensions;
    if (extensions == "obj" || extensions.starts_with("gltf")) continue;
    const std::unique_ptr<Assimp::BaseImporter> removed(importer.GetImporter(i));  // the importer no longer deletes it
    importer.UnregisterLoader(removed.get());
  }
}

/// Collects the library's warnings while it exists, each once: about what it leaves out.
class Messages {
 public:
  explicit Messages(std::vector<std::string>& warnings) {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(warnings), Assimp::Logger::Warn);
  }
  ~Messages() { Assimp::DefaultLogger::kill(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

 private:
  /// The logger deletes it.
  class Stream final : public Assimp::LogStream {
   public:
    explicit Stream(std::vector<std::string>& warnings) : warnings_(warnings) {}
    /// `text`: "Warn,  T0: MESSAGE\n".
    void write(const char* text) override {
      constexpr size_t kMost = 20, kLongest = 300;
      std::string message = text;
      if (const size_t head = message.find(": "); head != message.npos) message.erase(0, head + 2);
      while (message.ends_with('\n')) message.pop_back();
      // The library's checks after reading have no effect: unused vertices, sizes of coordinates.
      if (message.starts_with("Validation") || message.starts_with("ScenePreprocessor")) return;
      message = "the reader says: " + message.substr(0, kLongest);
      if (warnings_.size() < kMost && std::ranges::find(warnings_, message) == warnings_.end())
        warnings_.push_back(message);
    }

   private:
    std::vector<std::string>& warnings_;
  };
};

/// Materials keep their names, though equal ones could be joined. Points and lines are left out.
ImportedScene read(const std::filesystem::path& path) {
  ProcessLimits limits;
  Assimp::Importer importer;
  keep_readers(importer);
  auto* files = new ModelFiles(path, limits);
  importer.SetIOHandler(files);  // which the importer deletes
  files->check();
  std::vector<std::string> warnings;
  const Messages messages(warnings);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kSteps =
      aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;
  const aiScene* scene = importer.ReadFile(path.filename().string(), kSteps);
  std::vector<std::string> refusals = files->refusals();
  if (!scene || !scene->mRootNode) {
    std::string problem = importer.GetErrorString();
    for (const std::string& refusal : refusals) problem += "; " + refusal;
    throw std::runtime_error(problem.empty() ? "it is damaged" : problem);
  }
  ImportedScene result = converted(*scene);
  result.origin = files->origin();
  result.losses = files->losses();
  result.warnings = std::move(refusals);
  result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  return result;
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
    std::fputs("usage: frond-assimp MODEL (started by frond import)\n", stderr);
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
