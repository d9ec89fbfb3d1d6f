#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// First line of the tables of `envi_library_table`.
inline constexpr std::string_view kEnviLibrary = "ENVI Spectral Library";

/// Returns a spectral library of ENVI as a table with a column of wavelengths and one for each spectrum, scaled to
/// shares of 1 where the header states a factor; values that it marks as missing are empty. `header` and `data` are the
/// contents of its two files. Throws InputError at `where` if the header is incomplete or the data do not match it.
std::string envi_library_table(std::string_view header, std::string_view data, const Location& where);

/// Returns the content of a file of spectra as text: for a library of ENVI, named by its data (.sli, .slb) or its
/// header (.hdr), by envi_library_table. Throws InputError at `where` if a file cannot be read. `what`: the kind of
/// file, for messages.
std::string read_spectra_text(const std::filesystem::path& path, const Location& where, std::string_view what);

}  // namespace frond
