#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Refuses, by InputError, a file that cannot be written. "-" is standard output.
void check_text_output(const std::string& path);

/// The whole text, or an InputError and the old file.
void write_text(const std::string& path, std::string_view text);

/// A field of a CSV file, in quotes where it has to be (RFC 4180).
std::string csv_field(const std::string& text);

}  // namespace frond
