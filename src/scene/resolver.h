#pragma once

#include <map>
#include <set>

#include "core/log.h"
#include "core/params.h"
#include "core/shared_work.h"
#include "core/wavelengths.h"
#include "scene/format/description.h"
#include "scene/registry.h"

namespace frond {

struct ColorSpace;
class NormalBend;

/// A material created from the description.
struct MadeMaterial {
  std::shared_ptr<Material> material;
  bool needs_details = false;              ///< the material or one of its textures reads derivatives of hits
  std::shared_ptr<const NormalBend> bend;  ///< normal or bump map; nullptr: none
};

/// Resolves references of parameters: textures and materials by name, spectra by value, name or file. Objects are
/// created on first use. In an image of colours a spectrum that ends within the visible range is extended with a
/// warning; one that does not cover the render's wavelengths otherwise is an error at its parameter.
class SceneResolver final : public ParamResolver {
 public:
  SceneResolver(const SceneSettings& description, const Registry& registry, const WavelengthStrategy& wavelengths,
                const Log& log = silent_log());
  ~SceneResolver() override;

  std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<Material> material(const std::string& name, const Location& where) override;
  SpectrumPtr spectrum(const ParsedParam& param, SpectrumUse use) override;
  std::filesystem::path file(const std::string& name, const Location& where) override;
  /// Logs each warning once, even if a plug-in is created repeatedly.
  void warn(const Location& where, std::string_view message) override;

  /// Returns the material without its normal map, which is in `materials`.
  std::shared_ptr<Material> material(size_t index);
  /// All materials created so far, by index in the description.
  const std::map<size_t, MadeMaterial>& materials() const { return materials_; }

 private:
  template <class Texture>
  struct MadeTexture {
    std::shared_ptr<const Texture> texture;
    bool needs_details;  ///< the texture or one of its inputs
  };
  template <class Texture>
  using MadeTextures = std::map<std::string, MadeTexture<Texture>>;

  template <class Texture, class Info>
  std::shared_ptr<const Texture> texture(const std::string& name, const Location& where,
                                         TextureDescription::Value value, const PluginTable<Info>& table,
                                         MadeTextures<Texture>& made);
  template <class Make>
  auto make(const std::string& key, const Make& make, bool& needs_details);
  void propagate_needs(bool needs_details);
  [[noreturn]] void fail_unknown(std::string_view kind, const std::string& name,
                                 const std::vector<std::string_view>& names, const Location& where) const;
  void warn_of_clamping(const ParsedParam& p, double most);
  SpectrumPtr extended(SpectrumPtr s, const ParsedParam& p, SpectrumUse use);
  std::array<double, 3> clamped_rgb(const ParsedParam& p);

  const SceneSettings& description_;
  const Registry& registry_;
  const WavelengthStrategy& wavelengths_;
  const ColorSpace& color_space_;
  const Log& log_;
  const bool extends_spectra_;
  MadeTextures<FloatTexture> float_textures_;
  MadeTextures<SpectrumTexture> spectrum_textures_;
  std::map<size_t, MadeMaterial> materials_;
  SharedWork shared_;                  ///< of textures
  std::set<std::string> in_progress_;  ///< textures and materials being created: a second visit is a cycle
  std::set<std::string> warned_;
  std::vector<bool> needs_details_;  ///< for the objects being created, by nesting level
};

}  // namespace frond
