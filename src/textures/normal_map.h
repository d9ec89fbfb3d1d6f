#pragma once

#include "core/material.h"

namespace frond {

/// Replaces the shading normal of hits, which must have derivatives: a normal or bump map.
class NormalBend {
 public:
  virtual ~NormalBend() = default;
  /// Sets the shading frame and the derivatives dpdu and dpdv; leaves the hit unchanged where they are degenerate.
  virtual void bend(Hit& hit) const = 0;
};

/// Parameters of normal and bump maps, which every material accepts in addition to its own.
extern const PluginInfo normal_bend_params;

/// Returns the plug-in with only the parameters of NormalBend if `of_bend`, otherwise without them.
ParsedPlugin split_bend(const ParsedPlugin& material, bool of_bend);

/// Returns nullptr if the plug-in has no such parameters. Throws InputError.
std::shared_ptr<const NormalBend> make_normal_bend(const ParsedPlugin& material, ParamResolver& resolver);

/// Returns a material with its own normal map, as part of a mixture whose other material has another one.
std::shared_ptr<Material> bent_material(std::shared_ptr<Material> material, std::shared_ptr<const NormalBend> bend);

}  // namespace frond
