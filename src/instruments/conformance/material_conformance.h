#pragma once

#include "core/material.h"
#include "instruments/conformance/conformance.h"
#include "instruments/sweep.h"

namespace frond {

struct MaterialExamination {
  const Preparation& preparation;  ///< its wavelengths are those that the BSDFs are asked at
  ParamResolver& resolver;
  Claims claims;  ///< for every set of parameters, beside what the material claims itself
  ExaminationEffort effort;
  /// The first set or the wavelengths are what somebody asks for: where the material refuses them, that is no defect of
  /// it, and the InputError gets through.
  bool is_asked_for = false;
};

/// Makes the material from each set of parameters and runs all laws on its BSDF. Sets that the plugin refuses with an
/// InputError are passed over, save the first, which must be right. Throws InputError.
Findings examine(const MaterialInfo& info, std::span<const ParameterSet> sets, const MaterialExamination& how);

}  // namespace frond
