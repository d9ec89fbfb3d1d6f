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

/// A material of the description.
struct MadeMaterial {
  std::shared_ptr<Material> material;
  bool needs_details = false;              ///< it, or a texture of it, reads details of its hits
  std::shared_ptr<const NormalBend> bend;  ///< nullptr: normals are the surface's own
};

/// Looks up what parameters refer to: textures and materials by name, spectra by value, name or file. Things are made
/// when first asked for. A table that
/// ends within the visible is continued there, with a warning; a spectrum that does not reach the render's wavelengths
/// even so is an error at its parameter.
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
  /// Once, however often the same plugin is made.
  void warn(const Location& where, std::string_view message) override;

  /// Without its bend, which is with those of `materials`.
  std::shared_ptr<Material> material(size_t index);
  /// All that have been made, each once, by their index in the description.
  const std::map<size_t, MadeMaterial>& materials() const { return materials_; }

 private:
  template <class Texture>
  struct MadeTexture {
    std::shared_ptr<const Texture> texture;
    bool needs_details;  ///< it, or one that it is made of
  };
  template <class Texture>
  using MadeTextures = std::map<std::string, MadeTexture<Texture>>;

  template <class Texture, class Info>
  std::shared_ptr<const Texture> texture(const std::string& name, const Location& where,
                                         TextureDescription::Value value, const PluginTable<Info>& table,
                                         MadeTextures<Texture>& made);
  template <class Make>
  auto make(const std::string& key, const Make& make, bool& needs_details);
  void pass_on(bool needs_details);
  [[noreturn]] void fail_unknown(std::string_view kind, const std::string& name,
                                 const std::vector<std::string_view>& names, const Location& where) const;
  void warn_of_clamping(const ParsedParam& p, double most);
  SpectrumPtr in_the_visible(SpectrumPtr s, const ParsedParam& p, SpectrumUse use);
  std::array<double, 3> clamped_rgb(const ParsedParam& p);

  const SceneSettings& description_;
  const Registry& registry_;
  const WavelengthStrategy& wavelengths_;
  const ColorSpace& color_space_;
  const Log& log_;
  MadeTextures<FloatTexture> float_textures_;
  MadeTextures<SpectrumTexture> spectrum_textures_;
  std::map<size_t, MadeMaterial> materials_;
  SharedWork shared_;                  ///< of textures
  std::set<std::string> in_progress_;  ///< textures and materials being made: a second visit is a cycle
  std::set<std::string> warned_;
  std::vector<bool> needs_details_;  ///< of what is being made, level by level
};

}  // namespace frond
