#include "cli/measured_material.h"

#include <fmt/ranges.h>

#include "cli/material_words.h"
#include "core/log.h"
#include "instruments/beam.h"
#include "scene/resolver.h"

namespace frond {
MeasuredMaterial::MeasuredMaterial(const std::vector<std::string>& words, const Registry& registry,
                                   const std::vector<double>& wavelengths_nm, ThreadPool& pool, const Log& log,
                                   const std::filesystem::path& cache_dir)
    : label_(fmt::format("{}", fmt::join(words, " "))) {
  SceneDescription description = scene_of_materials(registry);
  description.materials.push_back({"", parse_material(words, registry).plugin});
  for (const double nm : wavelengths_nm) {
    const OneWavelength wavelength(nm);
    SceneResolver resolver(description, registry, wavelength);
    materials_.push_back(resolver.material(description.materials.size() - 1));
    materials_.back()->prepare({wavelength, pool, log, cache_dir});
  }
}

}  // namespace frond
