#pragma once

#include <algorithm>
#include <limits>

#include "scene/scene.h"
#include "study/choose/ladder.h"

namespace frond::choose {

/// A model that a leaf cannot use, and the reason.
struct Refusal {
  std::string name, reason;
};

/// Largest RMS errors of an image; infinite where none is stated.
struct ErrorLimits {
  double absolute = std::numeric_limits<double>::infinity();  ///< in linear SMPTE-C (white: 1)
  double relative = std::numeric_limits<double>::infinity();  ///< of each channel's mean over the image

  friend ErrorLimits smaller(const ErrorLimits& a, const ErrorLimits& b) {
    return {std::min(a.absolute, b.absolute), std::min(a.relative, b.relative)};
  }
};

/// A property that the scene leaves open: a leaf's model, or the wavelengths.
struct OpenChoice {
  std::string name;                  ///< name of the leaf's material; "wavelengths"
  std::vector<size_t> materials;     ///< indices in the description; empty: the choice is of wavelengths
  ErrorLimits limits = {};           ///< errors that the leaf allows
  std::vector<ModelOption> options;  ///< the last one is the reference
  std::vector<Refusal> refused = {};

  bool is_leaf() const { return !materials.empty(); }
  /// Index of the reference option.
  size_t reference() const { return options.size() - 1; }
};

/// The index of an option for each open choice.
using Configuration = std::vector<size_t>;

/// Whether a leaf's model is open.
bool has_open_leaf(const SceneSettings& description, const Registry& registry);
/// Whether the scene states a wavelength strategy.
bool names_wavelengths(const SceneSettings& description);

/// Returns the open choices of leaf models. Unnamed leaves with equal parameters are one choice. The possible models do
/// not depend on `wavelengths`. Throws InputError.
std::vector<OpenChoice> open_leaves(const SceneSettings& description, const Registry& registry,
                                    const WavelengthStrategy& wavelengths, const Ladder& ladder);

/// Writes the options into the description's leaves, starting from their original parameters, and into its option of
/// wavelengths.
void apply_answers(const std::vector<OpenChoice>& open_choices, const Configuration& answers, const Registry& registry,
                   SceneSettings& description);

}  // namespace frond::choose
