#pragma once

#include <span>

#include "core/material.h"

namespace frond {

/// The built-in materials, by name.
std::span<const MaterialInfo* const> builtin_materials();

}  // namespace frond
