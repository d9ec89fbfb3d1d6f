#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/format/plugin_text.h"

namespace frond::compare {

/// What stands for the scene's leaves in one curve of the chart.
struct Candidate {
  std::string label;  ///< what people call it: the text itself unless it begins with a name
  std::string text;   ///< as it was given, without the label
  PluginText material;
  std::string wavelengths;               ///< a PluginText; empty: those of the whole comparison
  std::optional<PluginText> integrator;  ///< over the scene's own
};

/// Candidates from `[LABEL:]MATERIAL[,parameter=value...][@wavelengths=PLUGIN...][@integrator=PLUGIN...]`, separated by
/// `;` or by commas: a part between commas that has no `=` begins another candidate. Throws InputError for other forms
/// and for two of one label.
std::vector<Candidate> parse_candidates(const std::vector<std::string>& texts);

/// A single one.
Candidate parse_candidate(const std::string& text);

}  // namespace frond::compare
