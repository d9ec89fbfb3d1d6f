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
};

/// Options to select from. Each list is sorted from the cheapest to the reference.
struct Ladder {
  std::vector<ModelOption> models, wavelengths;
};

/// Returns the models that the material `leaf` offers, and the wavelength strategies with colours.
Ladder standard_ladder(const Registry& registry);

}  // namespace frond::choose
