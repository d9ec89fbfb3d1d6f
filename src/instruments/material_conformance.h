#pragma once

#include <functional>

#include "core/material.h"
#include "instruments/conformance.h"
#include "instruments/sweep.h"

namespace frond {

/// What is claimed for one choice of a plugin's parameters.
using ClaimsOf = std::function<Claims(const ParsedPlugin&)>;

struct MaterialExamination {
  const Preparation& preparation;  ///< its wavelengths are those that the BSDFs are asked at
  ParamResolver& resolver;
  ClaimsOf claims = [](const ParsedPlugin&) { return Claims{}; };
  Effort effort;
};

/// Makes the material from each set of parameters and runs all laws on its BSDF. Sets that the plugin refuses with an
/// InputError are passed over, save the first, which must be right.
Findings examine(const MaterialInfo& info, std::span<const ParameterSet> sets, const MaterialExamination& how);

}  // namespace frond
