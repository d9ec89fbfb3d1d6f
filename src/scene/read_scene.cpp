#include "scene/read_scene.h"

#include "scene/format/parser.h"
#include "scene/pbrt_plugins.h"

namespace frond {

SceneDescription read_scene(const std::vector<std::filesystem::path>& paths, const Registry& registry, const Log& log,
                            const Unsupported& unsupported, Problems& problems) {
  SceneDescription description = parse_scene(paths, log, problems);
  translate_pbrt_plugins(description, registry, unsupported, log, problems);
  description.has_errors = !problems.empty();
  return description;
}

SceneDescription read_scene_text(const std::string& text, const std::string& name, const Registry& registry,
                                 const Log& log, const Unsupported& unsupported) {
  SceneDescription description = parse_scene_text(text, name, log);
  Problems problems;
  translate_pbrt_plugins(description, registry, unsupported, log, problems);
  problems.check();
  return description;
}

SceneDescription read_scene(const std::filesystem::path& path, const Registry& registry, const Log& log,
                            const Unsupported& unsupported) {
  Problems problems;
  SceneDescription description = read_scene(std::vector{path}, registry, log, unsupported, problems);
  problems.check();
  return description;
}

}  // namespace frond
