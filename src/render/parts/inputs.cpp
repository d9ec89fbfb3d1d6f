#include "render/parts/inputs.h"

#include <cstdlib>
#include <cstring>
#include <new>

#include "core/error.h"
#include "core/math/random.h"
#include "core/parallel.h"
#include "image/image_codec.h"
#include "scene/plugin_library.h"
#include "system/file_bytes.h"
#include "system/shared_object.h"

namespace frond {
namespace {

/// `output`: name of the parameter, if any, that names a file which the plug-in writes.
void add_files(const ParsedPlugin& plugin, const SceneDescription& scene, std::vector<std::filesystem::path>& files,
               std::string_view output = "") {
  for (const ParsedParam& p : plugin.params) {
    if (p.name == output) continue;
    const auto* words = std::get_if<std::vector<std::string>>(&p.values);
    if (!words) continue;
    for (const std::string& word : *words) {
      const std::filesystem::path path = scene.resolve(word, p.value_where);
      std::error_code error;
      if (std::filesystem::is_regular_file(path, error)) files.push_back(path);
    }
  }
}

/// Continues a hash. Words instead of bytes, for speed: instance tables have gigabytes.
uint64_t hash_words(std::string_view bytes, uint64_t hash) {
  size_t at = 0;
  for (; at + sizeof(uint64_t) <= bytes.size(); at += sizeof(uint64_t)) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    hash = mix64(hash ^ word) + 1;
  }
  return hash_bytes(bytes.substr(at), hash);
}

}  // namespace

std::vector<std::filesystem::path> input_files(const SceneDescription& scene, const ParsedPlugin& wavelengths) {
  std::vector<std::filesystem::path> files;
  for (const ParsedPlugin* plugin : {&wavelengths, &scene.camera, &scene.sampler, &scene.integrator, &scene.filter})
    add_files(*plugin, scene, files);
  add_files(scene.film, scene, files, "filename");
  for (const auto& t : scene.textures) add_files(t.plugin, scene, files);
  for (const auto& m : scene.materials) add_files(m.plugin, scene, files);
  for (const auto& a : scene.area_lights) add_files(a, scene, files);
  for (const auto& m : scene.media) add_files(m.plugin, scene, files);
  for (const auto& s : scene.shapes) add_files(s.plugin, scene, files);
  for (const auto& l : scene.lights) add_files(l.plugin, scene, files);
  for (const auto& o : scene.objects)
    for (const auto& s : o.shapes) add_files(s.plugin, scene, files);
  return files;
}

std::vector<std::filesystem::path> plugin_files(std::span<const std::string> plugins) {
  std::vector<std::filesystem::path> files;
  if (const char* folders = std::getenv("FROND_PLUGIN_PATH"))
    for (const auto& file : plugins_in(folders)) files.push_back(file);
  files.insert(files.end(), plugins.begin(), plugins.end());
  return files;
}

std::string loaded_from(std::span<const std::string> plugins) {
  std::string names;
  for (const auto& file : plugin_files(plugins)) names += " " + file.filename().string();
  return names.empty() ? names : "; plug-ins are loaded from" + names;
}

void rethrow_naming_plugins(std::span<const std::string> plugins) {
  const std::string names = loaded_from(plugins);
  if (names.empty()) throw;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    fail({}, "out of memory{}", names);
  } catch (...) {
    fail({}, "a plug-in has a defect: {}{}", plugin_defect(), names);
  }
}

uint64_t hash_program(uint64_t seed) { return hash_file(image_codec_file(), hash_file(own_file(), seed)); }

uint64_t hash_file(const std::filesystem::path& path, uint64_t seed) {
  uint64_t hash = seed;
  const uint64_t size = read_file_blocks(path, {}, [&hash](std::string_view block) { hash = hash_words(block, hash); });
  return hash_key(hash, size);
}

}  // namespace frond
