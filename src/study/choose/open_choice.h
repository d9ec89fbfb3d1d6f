#pragma once

#include "scene/scene.h"
#include "study/choose/ladder.h"

namespace frond::choose {

/// What a leaf cannot take, and why.
struct Refusal {
  std::string name, reason;
};

/// Something that a scene leaves open: the model of a leaf, or the wavelengths.
struct OpenChoice {
  std::string name;                  ///< of the leaf's material; "wavelengths"
  std::vector<size_t> materials;     ///< by their index in the description; none: the open_choice is of wavelengths
  double rms = 0;                    ///< what the leaf asks for
  std::vector<ModelOption> options;  ///< the last one counts as right
  std::vector<Refusal> refused = {};

  bool is_leaf() const { return !materials.empty(); }
  size_t reference() const { return options.size() - 1; }
  /// The best that is no random walk, as far as there is one: what pilots compare with first.
  size_t base() const { return is_leaf() && options.size() > 1 ? options.size() - 2 : reference(); }
};

/// An answer to each open_choice: the place of an option.
using Configuration = std::vector<size_t>;

bool has_open_leaf(const SceneSettings& description);
/// Whether the scene says which wavelengths it wants.
bool names_wavelengths(const SceneSettings& description);

/// Leaf by leaf; those without a name that are alike are one. Which models a leaf can take does not hang on the
/// wavelengths: any will do. Throws InputError.
std::vector<OpenChoice> open_leaves(const SceneSettings& description, const Registry& registry,
                                    const WavelengthStrategy& wavelengths, const Ladder& ladder);

/// Writes these answers into the description's leaves, as it had them when the open_choices were found, and into its
/// option of wavelengths.
void put_answers(const std::vector<OpenChoice>& open_choices, const Configuration& answers, const Registry& registry,
                 SceneSettings& description);

}  // namespace frond::choose
