#pragma once

#include <map>
#include <string>

#include "study/choose/choice.h"

namespace frond::choose {

/// For people: a table of what was measured, what was chosen and why.
std::string choice_text(const Choice& choice);

/// The same in a sentence.
std::string choice_sentence(const Choice& choice);

/// Where nothing but what counts as right was shown to be good enough: a warning that says so. Else "".
std::string choice_warning(const Choice& choice);

/// For an image's header: "frond:leaf:NAME", "frond:choice". Times are not in it: the same command gives the same file.
std::map<std::string, std::string> choice_attributes(const Choice& choice);

/// For programs: an object in JSON.
std::string choice_json(const Choice& choice);

}  // namespace frond::choose
