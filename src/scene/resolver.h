#pragma once

#include <map>
#include <set>

#include "core/params.h"
#include "core/wavelengths.h"
#include "scene/description.h"
#include "scene/registry.h"

namespace frond {

struct ColorSpace;

/// Looks up what parameters refer to: textures and materials by name, spectra by value, name or file. Things are made
/// when first asked for. A spectrum whose data do not reach the render's wavelengths is an error at its parameter.
class SceneResolver final : public ParamResolver {
 public:
  SceneResolver(const SceneSettings& description, const Registry& registry, const WavelengthStrategy& wavelengths);
  ~SceneResolver() override;

  std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<Material> material(const std::string& name, const Location& where) override;
  SpectrumPtr spectrum(const ParsedParam& param, bool emission) override;
  std::filesystem::path file(const std::string& name, const Location& where) override;

  std::shared_ptr<Material> material(size_t index);
  /// All that have been made, each once, by their places in the description.
  const std::map<size_t, std::shared_ptr<Material>>& materials() const { return materials_; }

 private:
  template <class Texture, class Info>
  std::shared_ptr<const Texture> texture(const std::string& name, const Location& where,
                                         TextureDescription::Value value, const PluginTable<Info>& table,
                                         std::map<std::string, std::shared_ptr<const Texture>>& made);

  const SceneSettings& description_;
  const Registry& registry_;
  const WavelengthStrategy& wavelengths_;
  const ColorSpace& color_space_;
  std::map<std::string, std::shared_ptr<const FloatTexture>> float_textures_;
  std::map<std::string, std::shared_ptr<const SpectrumTexture>> spectrum_textures_;
  std::map<size_t, std::shared_ptr<Material>> materials_;
  std::set<std::string> in_progress_;  ///< textures and materials being made: a second visit is a cycle
};

}  // namespace frond
