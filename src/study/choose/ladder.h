#pragma once

#include <string>
#include <vector>

#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond::choose {

/// One way to do a thing.
struct ModelOption {
  std::string name;
  PluginText plugin;
  /// CPU time of a sample, relative to the first option's. A constant, measured beforehand (docs/choosing.md): what a
  /// run measures varies, and the same command has to give the same image.
  double price;
};

/// What can be chosen from, each list from the cheapest to the one that counts as right.
struct Ladder {
  std::vector<ModelOption> models, wavelengths;
};

/// The models that the material `leaf` knows; wavelength strategies of colours.
Ladder standard_ladder(const Registry& registry);

}  // namespace frond::choose
