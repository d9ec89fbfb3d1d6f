#include "jobs/record/scene_in_memory.h"

#include <algorithm>
#include <tuple>

#include "jobs/record/common_params.h"
#include "scene/format/parser.h"
#include "scene/format/words.h"

namespace frond {
namespace {

/// Whether one of two parameters excludes the other.
bool excludes(const JobParam& a, const JobParam& b) {
  const auto lists = [](const JobParam& p, std::string_view name) {
    return std::ranges::count(split(std::string(p.excludes), ','), name) > 0;
  };
  return lists(a, b.name) || lists(b, a.name);
}

/// Returns the scene's words for a parameter of the job, without words that the job's own arguments replace: swaps of
/// the same material.
std::vector<std::string> kept_words(const SceneInMemory& scene, const Arguments& args, std::string_view name) {
  std::vector<std::string> words = scene.arguments.words(name);
  if (name != "swap" || !args.given(name)) return words;
  const auto from = [](const std::string& word) { return word.substr(0, word.find('=')); };
  std::erase_if(words, [&](const std::string& word) {
    return std::ranges::any_of(args.words("swap"), [&](const std::string& own) { return from(own) == from(word); });
  });
  return words;
}

/// Whether the job inherits the scene's value of a parameter. Wavelengths for colours are not bands of a measurement.
bool inherits(const SceneInMemory& scene, const Arguments& args, const JobParam& p) {
  if (!args.declares(p.name) || p.name == "strict" || p.positional) return false;
  for (const JobParam* other : args.params())
    if (args.given(other->name) && excludes(*other, p)) return false;
  if (p.name != "wavelengths") return p.name == "swap" || !args.given(p.name);
  const JobParam& own = **std::ranges::find(args.params(), p.name, &JobParam::name);
  const bool is_list = own.kind == ArgumentKind::numbers, needs_bands = is_list || !own.default_value.empty();
  return !args.given(p.name) && (!needs_bands || scene.has_bands) &&
         (!is_list || parse_numbers(scene.arguments.text(p.name)));
}

/// Writes the crop of the arguments into the film.
void apply_crop(const Arguments& args, ParsedPlugin& film) {
  for (const auto& [name, type, param] : {std::tuple{"crop", "float", "cropwindow"},
                                          {"pixels", "integer", "pixelbounds"},
                                          {"pixel", "integer", "pixelbounds"}}) {
    std::vector<double> bounds = args.numbers(name);
    if (bounds.empty()) continue;
    if (bounds.size() == 2) bounds = {bounds[0], bounds[0] + 1, bounds[1], bounds[1] + 1};
    std::erase_if(film.params, [](const ParsedParam& p) { return p.name == "cropwindow" || p.name == "pixelbounds"; });
    film.params.push_back(parsed_numbers(type, param, std::move(bounds)));
  }
}

/// Throws InputError for the first file that has changed.
void check_unchanged(const SceneInMemory& scene) {
  for (const FileState& file : scene.files) {
    const std::vector<FileState> now = states_of({file.path});
    if (now.empty() || now[0].size != file.size || now[0].time != file.time)
      fail({}, "\"{}\" has changed since the scene \"{}\" was loaded: load it again", file.path.string(), scene.name);
  }
}

}  // namespace

std::vector<FileState> states_of(const std::vector<std::filesystem::path>& files) {
  std::vector<FileState> states;
  for (const auto& path : files) {
    std::error_code no_size, no_time;
    const FileState state{path, std::filesystem::file_size(path, no_size),
                          std::filesystem::last_write_time(path, no_time)};
    if (!no_size && !no_time) states.push_back(state);
  }
  return states;
}

std::map<size_t, GivenScene> given_scenes(const std::map<size_t, SceneInMemory>& scenes, Arguments& args) {
  std::map<size_t, GivenScene> given;
  for (const auto& [index, scene] : scenes) {
    const Arguments& loaded = scene.arguments;
    Arguments left(loaded.params(), args.spelling());
    for (const JobParam* p : loaded.params()) {
      if (p->positional || p->name == "strict" || !loaded.given(p->name)) continue;
      if (scenes.size() > 1 || !args.declares(p->name)) {
        left.set(p->name, loaded.words(p->name));
      } else if (inherits(scene, args, *p)) {
        std::vector<std::string> words = kept_words(scene, args, p->name);
        if (args.given(p->name)) words.insert(words.end(), args.words(p->name).begin(), args.words(p->name).end());
        args.set(p->name, words);
      }
    }
    given.emplace(index, GivenScene{scene, std::move(left)});
  }
  return given;
}

/// A single file is always a scene, so that an incomplete one is reported as such.
std::vector<SceneInput> scenes_of(const JobRun& run, std::string_view name) {
  std::vector<SceneInput> scenes;
  const std::vector<std::string>& files = run.args.words(name);
  bool is_open = false;  // the last scene lacks WorldBegin
  for (size_t i = 0; i < files.size(); ++i) {
    const auto given = run.scenes.find(i);
    if (given != run.scenes.end()) {
      if (is_open) fail({}, "{} is not a whole scene: it lacks WorldBegin", scenes.back().files.back().string());
      scenes.push_back({{files[i]}, &given->second});
      continue;
    }
    if (!is_open) scenes.emplace_back();
    scenes.back().files.emplace_back(files[i]);
    is_open = files.size() > 1 && !contains_world(files[i]);
  }
  return scenes;
}

SceneDescription read_scene(const JobRun& run, const SceneInput& input, Problems& problems) {
  Session& session = run.session();
  if (!input.given) return session.read(input.files, unsupported_of(run.args), problems);
  const auto& [scene, overrides] = *input.given;
  if (!problems.attempt([&, &scene = scene] { check_unchanged(scene); })) return {};
  SceneDescription description{scene.settings, scene.shapes.shapes, scene.shapes.objects, scene.shapes.instances};
  apply_scene_flags(overrides, description);
  apply_crop(overrides, description.film);
  if (overrides.given("spp"))
    set_param(description.sampler.params, parsed_numbers("integer", "pixelsamples", {double(overrides.count("spp"))}));
  apply_overrides(overrides_of(overrides), description, session.registry(), run.log());
  return description;
}

SceneDescription read_scene(const JobRun& run, const SceneInput& input) {
  Problems problems;
  SceneDescription description = read_scene(run, input, problems);
  problems.check();
  return description;
}

}  // namespace frond
