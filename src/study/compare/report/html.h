#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "report/table.h"

namespace frond::compare {

/// Returns the text escaped for HTML content and attributes.
std::string html_text(std::string_view text);

/// Returns a table with its name above and a note below.
std::string to_html(const Table& table, const std::string& note);

std::string base64(std::span<const unsigned char> bytes);

/// Returns the values as 16-bit floats (IEEE 754 binary16, little-endian) in base64. Values out of range become the
/// largest.
std::string half_floats(std::span<const float> values);

/// Replaces `{{name}}` by values. An unknown name is a logic error.
std::string filled(std::string_view page, const std::map<std::string, std::string>& values);

}  // namespace frond::compare
