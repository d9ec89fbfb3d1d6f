#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "report/table.h"

namespace frond::compare {

/// A text as HTML has it, in content and in attributes.
std::string html_text(std::string_view text);

/// A table of texts with its name above it and a note below.
std::string to_html(const Table& table, const std::string& note);

std::string base64(std::span<const unsigned char> bytes);

/// The values as 16-bit floats (IEEE 754 binary16, little-endian), in base64. What is too large becomes the largest.
std::string half_floats(std::span<const float> values);

/// Puts values in place of `{{name}}`. Names that are not given are an error of ours.
std::string filled(std::string_view page, const std::map<std::string, std::string>& values);

}  // namespace frond::compare
