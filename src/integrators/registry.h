#pragma once

#include <span>

#include "core/integrator.h"

namespace frond {

std::span<const IntegratorInfo* const> builtin_integrators();

}  // namespace frond
