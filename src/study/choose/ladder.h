#pragma once

#include <string>
#include <vector>

#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond::choose {

/// One option of an open choice: a model or a wavelength strategy.
struct ModelOption {
  std::string name;
  PluginText plugin;
  /// CPU time of a sample relative to the first option. A constant measured beforehand (docs/selection.md), because
  /// measured times vary and equal commands must give equal images.
  double price;
  /// Whether the option renders the image that the search holds for right. It is then a leaf's last option.
  bool is_exact = false;
};

/// Options to select from. Each list is sorted from the cheapest on; its last option is exact. `leaf_solved` is exact
/// too: `abm` converges to the same image, with more noise, and is an option only of leaves that `leaf_solved` refuses.
struct Ladder {
  std::vector<ModelOption> models, wavelengths;
};

/// Returns the models that the material `leaf` offers, and the wavelength strategies with colours.
Ladder standard_ladder(const Registry& registry);

}  // namespace frond::choose
