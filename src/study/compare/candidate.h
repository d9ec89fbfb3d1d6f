#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/format/plugin_text.h"

namespace frond::compare {

/// A candidate: a material that replaces the scene's leaves, with its wavelengths and integrator; one curve of the
/// chart.
struct Candidate {
  std::string label;  ///< name in reports: `text`, unless the argument begins with a label
  std::string text;   ///< as given, without the label
  PluginText material;
  std::string wavelengths;               ///< a PluginText; empty: the comparison's
  std::optional<PluginText> integrator;  ///< overrides the scene's
};

/// Parses candidates `[LABEL:]MATERIAL[,parameter=value...][@wavelengths=PLUGIN...][@integrator=PLUGIN...]`, separated
/// by `;` or by commas: after a comma, a word without `=` begins another candidate. Throws InputError for other forms
/// and for equal labels.
std::vector<Candidate> parse_candidates(const std::vector<std::string>& texts);

/// Parses a single candidate. Throws InputError.
Candidate parse_candidate(const std::string& text);

}  // namespace frond::compare
