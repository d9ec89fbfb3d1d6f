#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Throws InputError if the file cannot be written. "-" is standard output.
void check_text_output(const std::string& path);

/// Writes the whole text. On failure throws InputError and leaves an old file unchanged.
void write_text(const std::string& path, std::string_view text);

/// Returns a field of a CSV file, quoted if necessary (RFC 4180).
std::string csv_field(const std::string& text);

}  // namespace frond
