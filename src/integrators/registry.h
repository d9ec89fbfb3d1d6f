#pragma once

#include <span>

#include "core/integrator.h"

namespace frond {

/// The built-in integrators, by name.
std::span<const IntegratorInfo* const> builtin_integrators();

}  // namespace frond
