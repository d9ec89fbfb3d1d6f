#pragma once

#include "core/material.h"

namespace frond {

/// Gives a material's hits, whose derivatives are known, another shading normal than their surface's.
class NormalBend {
 public:
  virtual ~NormalBend() = default;
  virtual void bend(Hit& hit) const = 0;
};

/// What bends the normals of any material, whichever it is; materials themselves know nothing of it.
extern const PluginInfo normal_bend_params;

/// The plugin's parameters that are no NormalBend's; or, `of_bend`, those that are.
ParsedPlugin split_bend(const ParsedPlugin& material, bool of_bend);

/// nullptr where the plugin has no such parameters. Throws InputError.
std::shared_ptr<const NormalBend> make_normal_bend(const ParsedPlugin& material, ParamResolver& resolver);

/// A material with a bend of its own, where it is part of a mixture: the other part has another normal.
std::shared_ptr<Material> bent_material(std::shared_ptr<Material> material, std::shared_ptr<const NormalBend> bend);

}  // namespace frond
