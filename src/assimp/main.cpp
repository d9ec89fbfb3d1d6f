#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "assimp/model_files.h"
#include "assimp/scene_conversion.h"
#include "imports/scene_stream.h"

// Program that reads a model file with the library assimp, in a process of its own with limits, and writes it as
// plain data to standard output. `frond import` starts it (imports/model_reader.h).

namespace frond {
namespace {

/// Removes all readers but those of OBJ and glTF: a file could otherwise select any of some fifty.
void keep_readers(Assimp::Importer& importer) {
  for (size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string extensions = importer.GetImporterInfo(i)->mFileExtensions;
    if (extensions == "obj" || extensions.starts_with("gltf")) continue;
    const std::unique_ptr<Assimp::BaseImporter> removed(importer.GetImporter(i));  // the importer no longer deletes it
    importer.UnregisterLoader(removed.get());
  }
}

/// Materials keep their names, though equal ones could be joined. Points and lines are left out.
ImportedScene read(const std::filesystem::path& path) {
  ProcessLimits limits;
  Assimp::Importer importer;
  keep_readers(importer);
  auto* files = new ModelFiles(path, limits);
  importer.SetIOHandler(files);  // which the importer deletes
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
  result.warnings = std::move(refusals);
  return result;
}

}  // namespace
}  // namespace frond

/// Exit code 0: the scene is on standard output. 1: the reason is on standard error.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: frond-assimp MODEL (started by frond import)\n", stderr);
    return 2;
  }
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
