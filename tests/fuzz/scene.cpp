// Scene files up to a scene that is ready to be rendered, with a film of 2 x 2 pixels and one thread.

#include "render/session.h"
#include "scene/format/plugin_text.h"
#include "tests/fuzz/scene_input.h"

using namespace frond;

/// The film's size decides how long a scene takes to load; limits of the size are the parser's part of the film.
static void shrink(SceneDescription& scene) {
  std::vector<ParsedParam>& params = scene.film.params;
  std::erase_if(params, [](const ParsedParam& p) { return p.name == "pixelbounds" || p.name == "cropwindow"; });
  for (const char* side : {"xresolution", "yresolution"}) set_param(params, parsed_numbers("integer", side, {2}));
}

/// Whether the scene's materials compute tables, which takes seconds and is no part of reading a file.
static bool computes_tables(const SceneDescription& scene) {
  const auto is_slow = [](const ParsedPlugin& plugin) {
    return plugin.name == "leaf" || plugin.name == "leaf_solved" || plugin.name == "leaf_simplified";
  };
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [&](const MaterialDescription& m) { return is_slow(m.plugin); });
}

FROND_FUZZ_TARGET(scene, bytes) {
  static Session session(silent_log(), {.threads = 1});
  const fuzz::SceneInput input(bytes);
  fuzz::accepts([&] {
    SceneDescription scene = session.read_text(input.text(), input.name());
    shrink(scene);
    fuzz::accepts([&] { session.check(scene); });
    if (computes_tables(scene)) return;
    const LoadedScene loaded = session.load(std::move(scene));
    const FilmSettings& film = loaded.film_format().settings;
    fuzz::require(film.width == 2 && film.height == 2, "the film has its size");
    fuzz::require_finite(loaded.film_format().white, "the film's white");
    fuzz::require(std::isfinite(loaded.scene().radius()) && loaded.scene().radius() >= 0, "the scene's size is finite");
  });
}
