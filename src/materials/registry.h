#pragma once

#include <span>

#include "core/material.h"

namespace frond {

/// The built-in materials, by name.
std::span<const MaterialInfo* const> builtin_materials();

/// Returns the record of the open leaf material for the leaf models among these materials, which are the choices of its
/// parameter "model". Thread-safe; the record is never destroyed.
const MaterialInfo& open_leaf_of(std::span<const MaterialInfo* const> materials);

}  // namespace frond
