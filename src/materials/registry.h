#pragma once

#include <span>

#include "core/material.h"

namespace frond {

std::span<const MaterialInfo* const> builtin_materials();

}  // namespace frond
