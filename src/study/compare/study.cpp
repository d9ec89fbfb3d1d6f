#include "study/compare/study.h"

#include <algorithm>
#include <cmath>

#include "core/log.h"
#include "scene/leaf_models.h"
#include "scene/resolver.h"
#include "study/paired_films.h"

namespace frond::compare {
namespace {

/// Scales the film, or its crop, to `size` pixels along the longer side.
void resize(ParsedPlugin& film, const FilmSettings& s, int size) {
  const double scale = double(size) / std::max(s.crop.width(), s.crop.height());
  const auto scaled = [scale](int pixels) { return std::max(1.0, std::round(pixels * scale)); };
  std::erase_if(film.params, [](const ParsedParam& p) {
    return p.name == "xresolution" || p.name == "yresolution" || p.name == "cropwindow" || p.name == "pixelbounds";
  });
  film.params.push_back(parsed_numbers("integer", "xresolution", {scaled(s.width)}));
  film.params.push_back(parsed_numbers("integer", "yresolution", {scaled(s.height)}));
  if (s.crop.width() == s.width && s.crop.height() == s.height) return;
  const auto at = [scale](int pixel) { return std::round(pixel * scale); };
  film.params.push_back(parsed_numbers(
      "integer", "pixelbounds",
      {at(s.crop.x0), at(s.crop.x0) + scaled(s.crop.width()), at(s.crop.y0), at(s.crop.y0) + scaled(s.crop.height())}));
}

/// Candidates replace open leaves, so their requests are removed.
void remove_error_requests(SceneSettings& description, const Registry& registry) {
  for (MaterialDescription& m : description.materials)
    if (m.plugin.name == open_leaf(registry).name)
      std::erase_if(m.plugin.params, [](const ParsedParam& p) { return p.name == "maxrms" || p.name == "model"; });
}

std::vector<std::string> leaf_names(const SceneSettings& description, const Registry& registry) {
  std::vector<std::string> names;
  for (const size_t i : leaf_materials(description, registry))
    if (const std::string name = description.materials[i].shown_name(); std::ranges::find(names, name) == names.end())
      names.push_back(name);
  return names;
}

}  // namespace

Study::Study(Session& session, const StudyOptions& options)
    : Study(session, session.read(options.scene, options.unsupported), options) {}

Study::Study(Session& session, SceneDescription description, const StudyOptions& options)
    : session_(session), description_(std::move(description)) {
  apply_overrides({.wavelengths = options.wavelengths, .seed = options.seed}, description_, registry(), session.log());
  resize(description_.film, session.film(description_), options.size);
  film_ = session.film(description_);
  remove_error_requests(description_, registry());
  leaves_ = options.leaves.empty() ? leaf_names(description_, registry()) : options.leaves;
  if (leaves_.empty()) fail({}, "{}: none of the materials is a leaf; --leaf names the one to replace", options.scene);
  if (options.leaves.empty()) swaps_.push_back({"*", {}});
  for (const std::string& leaf : options.leaves) swaps_.push_back({leaf, {}});
}

/// Returns the description with the candidate's material.
SceneDescription Study::described(const Candidate& candidate, const Log& log) const {
  SceneDescription description = description_;
  apply_overrides(
      {.swaps = swaps_to(candidate.material), .wavelengths = candidate.wavelengths, .integrator = candidate.integrator},
      description, registry(), log);
  return description;
}

std::shared_ptr<const Scene> Study::scene(const Candidate& candidate) const {
  auto scene = std::make_shared<const Scene>(described(candidate, session_.log()), registry(), session_.pool(),
                                             session_.log(), session_.cache(), first_.get());
  if (!first_) first_ = scene;
  return scene;
}

std::vector<MaterialSwap> Study::swaps_to(const PluginText& material) const {
  std::vector<MaterialSwap> swaps = swaps_;
  for (MaterialSwap& swap : swaps) swap.to = material;
  return swaps;
}

std::unique_ptr<Sampler> Study::sampler(const Scene& scene, uint64_t seed) const {
  return make_sampler(description_, registry(), scene.wavelengths(), seed);
}

std::unique_ptr<Integrator> Study::integrator(const Scene& scene, const PluginText& over) const {
  SceneResolver resolver(description_, registry(), scene.wavelengths());
  const IntegratorInfo& info = registry().integrators.get(over.name, {});
  ParsedPlugin plugin = description_.integrator;
  override_plugin(over, info, {}, plugin);
  auto integrator = make_checked(info, plugin.where, [&] { return info.make(Params(info, plugin, resolver)); });
  integrator->prepare(scene);
  return integrator;
}

Identity Study::identity(const Candidate& candidate) const {
  const SceneDescription description = described(candidate, silent_log());
  return identity_of(description, {.plugins = session_.plugins(),
                                   .seed = seed(),
                                   .wavelengths = wavelengths_plugin(description, registry()),
                                   .format = {.settings = film_},
                                   .color_space = {},
                                   .command = "compare " + candidate.text});
}

}  // namespace frond::compare
