#include "imports/model_reader.h"

#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <new>
#include <stdexcept>

#include "core/error.h"
#include "imports/scene_stream.h"
#include "system/child_process.h"
#include "system/lower_case.h"
#include "system/shared_object.h"
#include "system/utf8.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the program that reads models: beside the library, or where it is installed. The library may be one of those
/// in glibc-hwcaps, two folders below.
fs::path reader_program() {
  const fs::path own = own_file().parent_path(), name = FROND_MODEL_READER_FILE;
  for (const fs::path& folder : {own, own / "frond", own / "../..", own / "../../frond"}) {
    std::error_code error;
    if (fs::is_regular_file(folder / name, error)) return folder / name;
  }
  fail({}, "models are read by the program {}, which is not installed beside frond", FROND_MODEL_READER_FILE);
}

void check_name(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension != ".obj" && extension != ".gltf" && extension != ".glb")
    fail({}, "cannot import \"{}\": models are .obj, .gltf or .glb files; Blender and MeshLab convert others",
         path.string());
  std::error_code error;
  if (!fs::exists(path, error)) fail({}, "cannot read \"{}\": there is no such file", path.string());
  if (!fs::is_regular_file(path, error)) fail({}, "cannot read \"{}\": it is no regular file", path.string());
}

/// Makes a name printable: names in OBJ files may be in any encoding.
void make_printable(std::string& name) {
  const bool is_text = is_utf8(name);
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f || (!is_text && static_cast<unsigned char>(c) >= 0x80))
      c = '_';
}

/// Returns what went wrong in the child, in words.
std::string problem_of(const ChildResult& child) {
  if (WIFSIGNALED(child.status)) {
    const int signal = WTERMSIG(child.status);
    if (signal == SIGXCPU || signal == SIGKILL) return "it takes more time than 60 s and 2 s for each MB of its files";
    if (signal == SIGXFSZ) return "its triangles need more memory than this machine has";
    return "it is damaged: the reader was ended by " + exit_text(child.status);
  }
  std::string text = child.err.substr(0, 2000);
  std::ranges::replace(text, '\n', ' ');
  if (text == "it has no triangles") return text + "; of a point cloud, MeshLab or CloudCompare makes a mesh";
  return text.empty() ? "the reader ended with " + exit_text(child.status) : text;
}

}  // namespace

ImportedScene read_model(const fs::path& path) {
  check_name(path);
  const fs::path program = reader_program();
  const auto child = run_dependent({program.string(), fs::absolute(path).string()});
  if (!child) fail({}, "cannot run \"{}\"", program.string());
  if (WIFSIGNALED(child->status) && WTERMSIG(child->status) == SIGINT) fail({}, "the import was interrupted");
  if (child->status != 0) fail({}, "cannot read \"{}\": {}", path.string(), problem_of(*child));
  try {
    ImportedScene scene = decode(child->out);
    for (ImportedMaterial& material : scene.materials) make_printable(material.name);
    for (ImportedMesh& mesh : scene.meshes) make_printable(mesh.name);
    for (std::string& warning : scene.warnings) make_printable(warning);
    for (ImportedLoss& loss : scene.losses) {
      make_printable(loss.what);
      for (std::string& name : loss.materials) make_printable(name);
    }
    return scene;
  } catch (const std::runtime_error& error) {
    fail({}, "cannot read \"{}\": {}", path.string(), error.what());
  } catch (const std::length_error&) {
    fail({}, "cannot read \"{}\": it is damaged", path.string());
  }
}

}  // namespace frond
