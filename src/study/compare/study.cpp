#include "study/compare/study.h"

#include <algorithm>
#include <cmath>

#include "core/log.h"
#include "core/random.h"
#include "render/inputs.h"
#include "render/plugins.h"
#include "scene/read_scene.h"
#include "scene/resolver.h"
#include "study/paired_films.h"

namespace frond::compare {
namespace {

ParsedParam numbers(const char* type, const char* name, std::vector<double> values) {
  return {type, name, {}, {}, std::move(values)};
}

/// The same picture, or the same part of it, with `size` pixels along the longer side.
void resize(ParsedPlugin& film, const FilmSettings& s, int size) {
  const double scale = double(size) / std::max(s.crop.width(), s.crop.height());
  const auto scaled = [scale](int pixels) { return std::max(1.0, std::round(pixels * scale)); };
  std::erase_if(film.params, [](const ParsedParam& p) {
    return p.name == "xresolution" || p.name == "yresolution" || p.name == "cropwindow" || p.name == "pixelbounds";
  });
  film.params.push_back(numbers("integer", "xresolution", {scaled(s.width)}));
  film.params.push_back(numbers("integer", "yresolution", {scaled(s.height)}));
  if (s.crop.width() == s.width && s.crop.height() == s.height) return;
  const auto at = [scale](int pixel) { return std::round(pixel * scale); };
  film.params.push_back(numbers(
      "integer", "pixelbounds",
      {at(s.crop.x0), at(s.crop.x0) + scaled(s.crop.width()), at(s.crop.y0), at(s.crop.y0) + scaled(s.crop.height())}));
}

std::string name_of(const MaterialDescription& m) { return m.name.empty() ? m.plugin.name : m.name; }

/// Candidates answer what a leaf leaves open.
void drop_requests(SceneSettings& description) {
  for (MaterialDescription& m : description.materials)
    if (m.plugin.name == "leaf")
      std::erase_if(m.plugin.params, [](const ParsedParam& p) { return p.name == "maxrms" || p.name == "model"; });
}

std::vector<std::string> leaf_names(const SceneSettings& description, const Registry& registry) {
  std::vector<std::string> names;
  for (const size_t i : Scene::leaf_materials(description, registry))
    if (const std::string name = name_of(description.materials[i]); std::ranges::find(names, name) == names.end())
      names.push_back(name);
  return names;
}

}  // namespace

Study::Study(const StudyOptions& options, ThreadPool& pool, const Log& log)
    : options_(options),
      pool_(pool),
      log_(log),
      registry_(load_registry(options.plugins)),
      description_(read_scene(options.scene, registry_, log, options.unsupported)) {
  resize(description_.film, Scene::film_settings(description_, registry_), options.size);
  film_ = Scene::film_settings(description_, registry_);
  drop_requests(description_);
  leaves_ = options.leaves.empty() ? leaf_names(description_, registry_) : options.leaves;
  if (leaves_.empty()) fail({}, "{}: none of the materials is a leaf; --leaf names the one to replace", options.scene);
  if (options.leaves.empty()) swaps_.push_back({"*", {}});
  for (const std::string& leaf : options.leaves) swaps_.push_back({leaf, {}});
}

SceneOverrides Study::overrides_of(const Candidate& candidate) const {
  SceneOverrides overrides;
  overrides.wavelengths = candidate.wavelengths.empty() ? options_.wavelengths : candidate.wavelengths;
  overrides.integrator = candidate.integrator;
  overrides.seed = options_.seed;
  overrides.swaps = swaps_to(candidate.material);
  overrides.cache_dir = options_.cache;
  return overrides;
}

std::shared_ptr<const Scene> Study::scene(const Candidate& candidate) const {
  const SceneOverrides overrides = overrides_of(candidate);
  if (!first_) return first_ = std::make_shared<const Scene>(description_, registry_, overrides, pool_, log_);
  SharedWork shared;
  return std::make_shared<const Scene>(*first_, description_, registry_, overrides, pool_, log_, shared);
}

std::vector<MaterialSwap> Study::swaps_to(const PluginText& material) const {
  std::vector<MaterialSwap> swaps = swaps_;
  for (MaterialSwap& swap : swaps) swap.to = material;
  return swaps;
}

std::unique_ptr<Sampler> Study::sampler(const Scene& scene, uint64_t seed) const {
  return make_sampler(description_, registry_, scene.wavelengths(), seed);
}

std::unique_ptr<Integrator> Study::integrator(const Scene& scene, const PluginText& over) const {
  SceneResolver resolver(description_, registry_, scene.wavelengths());
  const IntegratorInfo& info = registry_.integrators.get(over.name, {});
  ParsedPlugin plugin = description_.integrator;
  override_plugin(over, info, {}, plugin);
  auto integrator = info.make(Params(info, plugin, resolver));
  integrator->prepare(scene);
  return integrator;
}

/// Those of the candidate's own material, integrator and wavelengths are among them.
std::vector<std::filesystem::path> Study::input_files(const Candidate& candidate) const {
  const SceneOverrides overrides = overrides_of(candidate);
  SceneDescription description = description_;
  apply_swaps(description, overrides.swaps, registry_, silent_log());
  if (const auto& own = overrides.integrator)
    override_plugin(*own, registry_.integrators.get(own->name, {}), {}, description.integrator);
  const auto [text, where] = wavelength_choice(description, overrides);
  return frond::input_files(description, wavelengths_plugin(text, where, registry_));
}

uint64_t Study::identity(const Candidate& candidate) const {
  std::string choices =
      fmt::format("{} {} {} {} {}", candidate.text, options_.wavelengths, film_.width, film_.height, seed());
  for (const std::string& leaf : options_.leaves) choices += '\n' + leaf;
  uint64_t hash = hash_bytes(choices, description_.content_hash);
  for (const auto& file : input_files(candidate)) hash = hash_file(file, hash);
  hash = hash_program(hash);
  for (const auto& file : plugin_files(options_.plugins)) hash = hash_file(file, hash);
  return hash;
}

}  // namespace frond::compare
