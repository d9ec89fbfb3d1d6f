#include "cli/specimen.h"

#include <fmt/ranges.h>

#include "instruments/beam.h"
#include "scene/description.h"
#include "scene/plugin_text.h"
#include "scene/resolver.h"

namespace frond {
namespace {

PluginText plugin_text(const std::vector<std::string>& words) {
  PluginText text{words[0], {}};
  for (size_t i = 1; i < words.size(); ++i) {
    const size_t equals = words[i].find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == words[i].size())
      fail({}, "a material looks like NAME parameter=value ...: \"{}\" in {}", words[i], fmt::join(words, " "));
    text.params.emplace_back(words[i].substr(0, equals), words[i].substr(equals + 1));
  }
  return text;
}

/// The material that is measured, and every other one by its plugin's name, for materials that take materials.
SceneDescription describe(const PluginText& text, const Registry& registry) {
  SceneDescription description;
  const MaterialInfo& info = registry.materials.get(text.name, {});
  MaterialDescription measured{"", {text.name, {}, {}}};
  set_params(text, info, {}, measured.plugin);
  description.materials.push_back(std::move(measured));
  for (const std::string_view name : registry.materials.names())
    description.materials.push_back({std::string(name), {std::string(name), {}, {}}});
  return description;
}

}  // namespace

Specimen::Specimen(const std::vector<std::string>& words, const Registry& registry,
                   const std::vector<double>& wavelengths_nm, ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir)
    : label_(fmt::format("{}", fmt::join(words, " "))) {
  const SceneDescription description = describe(plugin_text(words), registry);
  for (const double nm : wavelengths_nm) {
    const OneWavelength wavelength(nm);
    SceneResolver resolver(description, registry, wavelength);
    materials_.push_back(resolver.material(size_t{0}));
    materials_.back()->prepare({wavelength, pool, log, cache_dir});
  }
}

}  // namespace frond
