#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/fluorescence.h"
#include "core/material.h"
#include "jobs/record/job.h"

namespace frond {

/// Parameters of instruments that measure fluorescence, beside the flag --fluorescence.
constexpr JobParam excitation_param(std::string_view default_value) {
  return {"excitation",
          ArgumentKind::numbers,
          "Wavelengths of excitation.",
          {.default_value = default_value,
           .unit = "nm",
           .range = kExcitation_nm,
           .decides = true,
           .needs = "fluorescence"}};
}
constexpr JobParam emission_param(std::string_view default_value) {
  return {
      "emission",
      ArgumentKind::numbers,
      "Wavelengths of emission.",
      {.default_value = default_value, .unit = "nm", .range = kEmission_nm, .decides = true, .needs = "fluorescence"}};
}

/// A material under test and its fluorescence.
struct FluorescentSpecimen {
  std::string label;
  std::shared_ptr<Material> material;  ///< outlives its fluorescence
  std::shared_ptr<const Fluorescence> fluorescence;
  uint64_t seed;  ///< of its random numbers, which do not depend on the other materials
};

/// Returns the materials under test. Throws InputError for one that has no fluorescence; warns of one that emits
/// nothing.
std::vector<FluorescentSpecimen> fluorescent_specimens(const JobRun& run);

/// Returns the wavelengths of --excitation or --emission. Throws InputError unless they ascend.
std::vector<double> ascending_wavelengths(const Arguments& args, std::string_view name);

/// Returns the comment lines of a CSV file. Every result names the emission shape, which decides the ratio of its
/// peaks.
std::vector<std::string> fluorescence_notes(const JobRun& run, std::string_view instrument,
                                            const std::vector<FluorescentSpecimen>& specimens);

/// Returns the lines that name the materials and their emission shapes.
std::string emission_text(const std::vector<FluorescentSpecimen>& specimens);

/// Returns the result of `frond spectrophotometer --fluorescence`: matrices and balances of photons. The job declares
/// material, with, angles, excitation, emission, rays, seed and plot. Throws InputError.
Result fluorescence_result(const JobRun& run);

}  // namespace frond
