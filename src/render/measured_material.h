#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/material.h"
#include "scene/format/description.h"
#include "scene/registry.h"

namespace frond {

/// Changes materials before they are made; may be empty.
using AdjustMaterials = std::function<void(SceneDescription&, const Registry&)>;

/// A material given in text, `abm,specimen=soybean`, made without a scene and prepared for these wavelengths. Throws
/// InputError for unknown names, parameters that are wrong, and wavelengths that the material's data do not reach.
std::shared_ptr<Material> ready_material(const std::string& text, const Registry& registry,
                                         const WavelengthStrategy& wavelengths, ThreadPool& pool, const Log& log,
                                         const std::filesystem::path& cache_dir, const AdjustMaterials& adjust = {});

/// A material under test: given in text, made without a scene and prepared for wavelengths one by one.
class MeasuredMaterial {
 public:
  /// Throws as ready_material does.
  MeasuredMaterial(const std::string& text, const Registry& registry, const std::vector<double>& wavelengths_nm,
                   ThreadPool& pool, const Log& log, const std::filesystem::path& cache_dir);

  /// The text that it was given by.
  const std::string& label() const { return label_; }
  /// For random numbers: material_seed of the label.
  uint64_t seed() const { return seed_; }
  /// Prepared for the wavelength of that index.
  const Material& at(size_t wavelength) const { return *materials_[wavelength]; }

 private:
  std::string label_;
  uint64_t seed_;
  std::vector<std::shared_ptr<Material>> materials_;
};

}  // namespace frond
