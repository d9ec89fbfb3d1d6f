#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "leaf/table/table.h"

namespace frond::leaf {

/// Returns `make_table`'s result, cached on disk in `cache_dir` (empty: no cache) under a hash of everything that it
/// depends on. A damaged file is replaced; a file that cannot be written causes a warning. Reports the work in `log`
/// under `name`.
Table cached_table(const TableRequest& request, std::string_view name, const ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir);

/// Returns everything that a table depends on, as the comments at the head of its file: the request, the optical
/// constants, the versions of the code.
std::string describe(const TableRequest& request);

/// Returns a list of numbers as text: evenly spaced ones in short form, others one by one.
std::string list_text(const std::vector<double>& values);

/// Returns one line for the log: content and accuracy of the table.
std::string summary(const TableRequest& request, std::string_view name, const Table& table);

/// Returns the text of a table's cache file, with a checksum at its end.
std::string seal(const Table& table, std::string_view header);
/// Parses text that `seal` wrote under the same header into `table`; returns false if it is anything else.
bool unseal(std::string_view text, std::string_view header, Table& table);

}  // namespace frond::leaf
