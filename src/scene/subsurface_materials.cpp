#include "scene/subsurface_materials.h"

#include <algorithm>

#include "core/error.h"
#include "core/fluorescence.h"

namespace frond {

SubsurfaceMaterials subsurface_materials(std::span<const Material* const> materials) {
  SubsurfaceMaterials found;
  for (const Material* material : materials) found.push_back(dynamic_cast<const SubsurfaceMaterial*>(material));
  if (std::ranges::all_of(found, [](const auto* material) { return !material; })) found.clear();
  return found;
}

void set_subsurface(std::span<const Material* const> materials, const SceneSettings& description,
                    const WavelengthStrategy& wavelengths, Integrator& integrator) {
  SubsurfaceMaterials found = subsurface_materials(materials);
  if (found.empty()) return;
  const auto first = std::ranges::find_if(found, [](const auto* material) { return material != nullptr; });
  const ParsedPlugin& plugin = description.materials[size_t(first - found.begin())].plugin;
  auto* follows = dynamic_cast<SubsurfaceIntegrator*>(&integrator);
  if (!follows)
    fail(plugin.where, "integrator \"{}\" does not follow light under the surface of material \"{}\": \"path\" does",
         description.integrator.name, plugin.name);
  // Paths of fluorescence scatter at single points.
  if (has_fluorescence(wavelengths))
    fail(plugin.where, "fluorescence is not computed in scenes with material \"{}\"", plugin.name);
  follows->set_subsurface(std::move(found));
}

}  // namespace frond
