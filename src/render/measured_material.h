#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "core/material.h"
#include "instruments/beam.h"
#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond {

/// Material given as text, such as `abm,specimen=soybean`.
struct MaterialWords {
  const MaterialInfo& info;
  ParsedPlugin plugin;
};

/// Parses a material. Throws InputError for syntax errors, unknown names and values of the wrong type.
MaterialWords parse_material(const std::string& text, const Registry& registry);

/// The parameters of a material, separated by blanks: `specimen=soybean thickness=1e-4`. The seeds of measurements are
/// hashes of this text, so that its format must not change.
std::string parameter_text(const PluginText& material);
/// Seed of a material's random numbers: hash of its name and its parameters.
uint64_t material_seed(const std::string& text);

/// Scene without shapes that has one named material for each material plug-in, under the plug-in's name. Materials with
/// parameters of kind material refer to these.
SceneDescription scene_of_materials(const Registry& registry);

/// Log that discards information and throws warnings as InputError. Measurements use it: a warning means that the
/// material is not the requested one.
class RefusingLog final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location& where, std::string_view message) const override {
    throw InputError(where, std::string(message));
  }
};

/// Function that changes the description of materials before they are made; may be empty.
using AdjustMaterials = std::function<void(SceneDescription&, const Registry&)>;

/// Makes a material from text such as `abm,specimen=soybean`, without a scene, and prepares it for these wavelengths.
/// Throws InputError for unknown names, wrong parameters, and wavelengths outside the range of the material's data.
std::shared_ptr<Material> prepared_material(const std::string& text, const Registry& registry,
                                            const WavelengthStrategy& wavelengths, ThreadPool& pool, const Log& log,
                                            const std::filesystem::path& cache_dir, const AdjustMaterials& adjust = {});

/// Material under test of an instrument: made from text, without a scene, once for each wavelength.
class MeasuredMaterial {
 public:
  /// Throws as prepared_material does.
  MeasuredMaterial(const std::string& text, const Registry& registry, const std::vector<double>& wavelengths_nm,
                   ThreadPool& pool, const Log& log, const std::filesystem::path& cache_dir);
  /// The same, made once for each beam of light, which is of one wavelength or of a band.
  MeasuredMaterial(const std::string& text, const Registry& registry, const std::vector<Beam>& beams, ThreadPool& pool,
                   const Log& log, const std::filesystem::path& cache_dir);

  /// Text from which the material was made.
  const std::string& label() const { return label_; }
  /// Seed for random numbers: material_seed of the label.
  uint64_t seed() const { return seed_; }
  /// Material prepared for the wavelength or the beam with this index.
  const Material& at(size_t wavelength) const { return *materials_[wavelength]; }

 private:
  std::string label_;
  uint64_t seed_;
  std::vector<std::shared_ptr<Material>> materials_;
};

}  // namespace frond
