#include "cli/leaf_words.h"

#include "scene/plugin_text.h"

namespace frond {
namespace {

/// A leaf on the command line is made of numbers and words alone.
class NoReferences final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location&) override { refuse(); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location&) override { refuse(); }
  std::shared_ptr<Material> material(const std::string&, const Location&) override { refuse(); }
  SpectrumPtr spectrum(const ParsedParam&, SpectrumUse) override { refuse(); }
  std::filesystem::path file(const std::string& name, const Location&) override { return name; }

 private:
  [[noreturn]] static void refuse() { fail({}, "a leaf's table is made for one leaf: numbers alone, no textures"); }
};

}  // namespace

Params leaf_from_words(const PluginInfo& info, const std::vector<std::string>& words) {
  std::string text(info.name);
  for (const std::string& word : words) text += "," + word;
  ParsedPlugin plugin{std::string(info.name), {}, {}};
  set_params(parse_plugin_text(text, {}), info, {}, plugin);
  static NoReferences none;
  return Params(info, plugin, none);
}

}  // namespace frond
