#pragma once

#include <span>

#include "core/bssrdf.h"
#include "core/integrator.h"
#include "scene/format/description.h"

namespace frond {

/// Returns the materials that have a BSSRDF, by index; empty if none has.
SubsurfaceMaterials subsurface_materials(std::span<const Material* const> materials);

/// Passes them to the integrator. Throws InputError at the material if the integrator does not follow BSSRDFs, or if
/// paths carry fluorescence.
void set_subsurface(std::span<const Material* const> materials, const SceneSettings& description,
                    const WavelengthStrategy& wavelengths, Integrator& integrator);

}  // namespace frond
