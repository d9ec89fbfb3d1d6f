#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// Returns `make_mode_table`'s result, cached on disk in `cache_dir` (empty: no cache) under a hash of everything that
/// it depends on. A damaged file is replaced; a file that cannot be written causes a warning. Reports the work in `log`
/// under `name`.
ModeTable cached_mode_table(const ModeTableRequest& request, std::string_view name, const ThreadPool& pool,
                            const Log& log, const std::filesystem::path& cache_dir);

/// Returns everything that a mode table depends on, as the comments at the head of its file.
std::string describe(const ModeTableRequest& request);

/// Returns one line for the log: content and accuracy of the table.
std::string summary(const ModeTableRequest& request, std::string_view name, const ModeTable& spectrum);

}  // namespace frond::leaf
