#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/fluorescence.h"
#include "core/material.h"

namespace frond {

/// Returns the fluorescence of each material, by its index; nullptr: it emits nothing. Throws InputError if none emits.
std::vector<std::shared_ptr<const Fluorescence>> fluorescence_by_material(std::span<const Material* const> materials,
                                                                          const Preparation& preparation);

}  // namespace frond
