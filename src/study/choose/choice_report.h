#pragma once

#include <map>
#include <string>

#include "study/choose/choice.h"

namespace frond::choose {

/// Returns a text with a table of the measurements, the selection and its reason.
std::string choice_text(const Choice& choice);

/// Returns the selection in one sentence.
std::string choice_sentence(const Choice& choice);

/// Returns attributes of an image's header: "frond:leaf:NAME", "frond:choice". They contain no times, so that equal
/// commands write equal files.
std::map<std::string, std::string> choice_attributes(const Choice& choice);

/// Returns the selection as a JSON object.
std::string choice_json(const Choice& choice);

}  // namespace frond::choose
