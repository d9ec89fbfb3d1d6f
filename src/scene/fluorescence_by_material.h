#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/fluorescence.h"
#include "core/integrator.h"
#include "core/material.h"
#include "core/params.h"

namespace frond {

/// Returns the fluorescence of each material, by its index; nullptr: it emits nothing. Throws InputError if none emits.
std::vector<std::shared_ptr<const Fluorescence>> fluorescence_by_material(std::span<const Material* const> materials,
                                                                          const Preparation& preparation);

/// Returns the integrator as one that computes fluorescence. Throws InputError at the plug-in's place if it does not.
FluorescenceIntegrator& fluorescence_integrator(Integrator& integrator, const ParsedPlugin& plugin);

}  // namespace frond
