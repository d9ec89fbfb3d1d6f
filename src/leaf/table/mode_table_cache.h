#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// `make_mode_table`, kept on disk in `cache_dir` (empty: not kept) under a hash of all that it depends on. A file
/// that is damaged is made anew; one that cannot be written costs a warning. Says through `log` what it took, with
/// `name`.
ModeTable cached_mode_table(const ModeTableRequest& request, std::string_view name, const ThreadPool& pool,
                            const Log& log, const std::filesystem::path& cache_dir);

/// Everything that a spectrum depends on, as comments of its file.
std::string describe(const ModeTableRequest& request);

/// One line for people: what the spectrum holds and how good it is.
std::string summary(const ModeTableRequest& request, std::string_view name, const ModeTable& spectrum);

}  // namespace frond::leaf
