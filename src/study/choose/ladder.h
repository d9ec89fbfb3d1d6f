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
  /// Whether the option renders the image that the search takes as correct. It is then a leaf's last option.
  bool is_exact = false;
};

/// Options to select from. Each list is sorted from the cheapest on; its last option is exact. Other options may be
/// exact too: a leaf has the options up to the first exact one that it supports.
struct Ladder {
  std::vector<ModelOption> models, wavelengths;
};

/// Returns the leaf models of the registry that have its reference (scene/leaf_models.h), and the wavelength strategies
/// with colours.
Ladder standard_ladder(const Registry& registry);

}  // namespace frond::choose
