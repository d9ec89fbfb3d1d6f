#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/params.h"
#include "core/plugin.h"

namespace frond {

/// One choice of values for a plugin's parameters.
struct ParameterSet {
  std::string label;  ///< "defaults", "thickness = 0.01", ...
  ParsedPlugin plugin;
};

/// Options of `parameter_sweep`.
struct SweepOptions {
  std::vector<ParsedParam> pinned = {};  ///< given in every set and not swept, if the plug-in declares them
  int random_corners = 4;                ///< sets with every parameter at one end of its range
  int random_points = 4;                 ///< sets with every parameter inside its range
  bool infinite_ends = true;             ///< vary parameters to 1000 in place of an infinite end of their range
  uint64_t seed = 1;
};

/// Returns sets of parameters over a plug-in's declared ranges: the defaults, each end of each parameter's range and
/// each choice alone, random corners and points inside. File names, other free strings and parameters in place of
/// others keep their defaults. 1000 replaces an infinite end, and twice the default (at least 1) for points inside.
/// Sets may violate rules between parameters; the plug-in then rejects them.
std::vector<ParameterSet> parameter_sweep(const PluginInfo& info, const SweepOptions& options);

/// Parameters that the sets of `parameter_sweep` vary, and those that are neither varied nor pinned: free strings,
/// names, what stands in place of others, and without `infinite_ends` ranges that have no end. A parameter with one end
/// is in both lists.
struct SweptParams {
  std::vector<std::string> varied, unvaried;
};
SweptParams swept_params(const PluginInfo& info, const SweepOptions& options);

/// Parameter resolver without a scene: spectra are the numbers given, linear in between (rgb: their mean at every
/// wavelength), every material name resolves to `material_by_name`, and there are no textures.
class PlainResolver final : public ParamResolver {
 public:
  using MaterialByName = std::function<std::shared_ptr<Material>(const std::string& name)>;
  explicit PlainResolver(MaterialByName material_by_name) : material_by_name_(std::move(material_by_name)) {}

  std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location& where) override;
  std::shared_ptr<Material> material(const std::string& name, const Location&) override {
    return material_by_name_(name);
  }
  SpectrumPtr spectrum(const ParsedParam& param, SpectrumUse use) override;
  std::filesystem::path file(const std::string& name, const Location&) override { return name; }

 private:
  MaterialByName material_by_name_;
};

}  // namespace frond
