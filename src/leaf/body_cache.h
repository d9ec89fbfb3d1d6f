#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/body_spectrum.h"

namespace frond::leaf {

/// `make_body_spectrum`, kept on disk in `cache_dir` (empty: not kept) under a hash of all that it depends on. A file
/// that is damaged is made anew; one that cannot be written costs a warning. Says through `log` what it took, with
/// `name`.
BodySpectrum cached_body_spectrum(const BodyRequest& request, std::string_view name, const ThreadPool& pool,
                                  const Log& log, const std::filesystem::path& cache_dir);

/// Everything that a spectrum depends on, as comments of its file.
std::string describe(const BodyRequest& request);

/// The file: `header` and the grid's size as comments, the index of each wavelength, and a line for each row of each
/// mode, which says column, lit side and way out before the numbers of the row (docs/solved_leaf.md).
std::string to_text(const BodySpectrum& spectrum, std::string_view header);
/// What `to_text` wrote under the same header; false if it is anything else.
bool parse_body_spectrum(std::string_view text, std::string_view header, BodySpectrum& spectrum);

}  // namespace frond::leaf
