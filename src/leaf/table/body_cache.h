#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "leaf/table/body_spectrum.h"

namespace frond::leaf {

/// `make_body_spectrum`, kept on disk in `cache_dir` (empty: not kept) under a hash of all that it depends on. A file
/// that is damaged is made anew; one that cannot be written costs a warning. Says through `log` what it took, with
/// `name`.
BodySpectrum cached_body_spectrum(const BodyRequest& request, std::string_view name, const ThreadPool& pool,
                                  const Log& log, const std::filesystem::path& cache_dir);

/// Everything that a spectrum depends on, as comments of its file.
std::string describe(const BodyRequest& request);

/// One line for people: what the spectrum holds and how good it is.
std::string summary(const BodyRequest& request, std::string_view name, const BodySpectrum& spectrum);

}  // namespace frond::leaf
