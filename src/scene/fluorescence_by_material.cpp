#include "scene/fluorescence_by_material.h"

#include "core/error.h"

namespace frond {

std::vector<std::shared_ptr<const Fluorescence>> fluorescence_by_material(std::span<const Material* const> materials,
                                                                          const Preparation& preparation) {
  std::vector<std::shared_ptr<const Fluorescence>> by_material;
  bool is_black = true;
  for (const Material* material : materials) {
    auto& fluorescence = by_material.emplace_back();
    const auto* fluorescent = dynamic_cast<const FluorescentMaterial*>(material);
    if (!fluorescent) continue;
    auto made = fluorescent->fluorescence(preparation);
    if (made->is_black()) continue;
    fluorescence = std::move(made);
    is_black = false;
  }
  if (is_black)
    fail({},
         "no surface of the scene fluoresces: give a leaf model that can (docs/fluorescence.md) a quantum yield, as in "
         "\"float fluorescence\" 0.01");
  return by_material;
}

FluorescenceIntegrator& fluorescence_integrator(Integrator& integrator, const ParsedPlugin& plugin) {
  auto* found = dynamic_cast<FluorescenceIntegrator*>(&integrator);
  if (!found) fail(plugin.where, "integrator \"{}\" computes no fluorescence: \"path\" does", plugin.name);
  return *found;
}

}  // namespace frond
