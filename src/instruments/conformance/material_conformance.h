#pragma once

#include <functional>

#include "core/error.h"
#include "core/material.h"
#include "instruments/conformance/conformance.h"
#include "instruments/sweep.h"

namespace frond {

/// Input of `examine` for a material plug-in.
struct MaterialExamination {
  const Preparation& preparation;  ///< determines the wavelengths of the BSDFs
  ParamResolver& resolver;
  Claims claims;  ///< for all sets of parameters, in addition to the material's own
  ExaminationEffort effort;
  /// The user gave the first set or the wavelengths: if the material refuses them this is no defect, and the InputError
  /// is passed on.
  bool is_asked_for = false;
  bool may_refuse_all = false;  ///< the first set need not be valid
  /// Called for each set that the plug-in refuses, with the reason; may be empty.
  std::function<void(const ParameterSet&, const InputError&)> on_refusal = {};
};

/// Makes the material from each set of parameters and tests all laws on its BSDF. Sets that the plug-in refuses with an
/// InputError are skipped, except the first, which must be valid. Throws InputError.
Findings examine(const MaterialInfo& info, std::span<const ParameterSet> sets, const MaterialExamination& how);

}  // namespace frond
