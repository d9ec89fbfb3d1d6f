#pragma once

#include <cstdint>
#include <optional>

#include "core/log.h"
#include "scene/format/description.h"

namespace frond {

/// Values of a scene's `Option` directives, with overrides.
struct SceneOptions {
  std::optional<uint64_t> seed;  ///< empty: the sampler's seed
  std::string wavelengths;       ///< a PluginText
  Location wavelengths_where;
  std::optional<Vec2> period;  ///< empty: no repetition
  Location period_where;
  bool has_pixel_jitter = true, has_wavelength_jitter = true, filters_textures = true, extends_spectra = false;
};

/// Throws InputError.
SceneOptions read_options(const SceneSettings& description, const Log& log = silent_log());

/// Sets the wavelength strategy. `text`: a PluginText.
void set_wavelengths(SceneSettings& description, const std::string& text, const Location& where = {});

/// Resolver for plug-ins that may refer to files but not to other objects of the scene: options, wavelengths, films.
class OptionResolver final : public ParamResolver {
 public:
  explicit OptionResolver(const SceneSettings& description, const Log& log = silent_log())
      : description_(description), log_(log) {}

 private:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<Material> material(const std::string&, const Location& w) override { none(w); }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse) override { none(p.where); }
  std::filesystem::path file(const std::string& name, const Location& w) override {
    return description_.resolve(name, w);
  }
  void warn(const Location& where, std::string_view message) override { log_.warn(where, message); }
  [[noreturn]] static void none(const Location& where) { fail(where, "an option cannot refer to the scene"); }

  const SceneSettings& description_;
  const Log& log_;
};

}  // namespace frond
