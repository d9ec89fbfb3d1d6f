#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/log.h"
#include "leaf/table/table.h"

namespace frond::leaf {

/// `make_table`, kept on disk in `cache_dir` (empty: not kept) under a hash of all that it depends on. A file that is
/// damaged is made anew; one that cannot be written costs a warning. Says through `log` what it took, with `name`.
Table cached_table(const TableRequest& request, std::string_view name, const ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir);

/// Everything that a table depends on, as comments of its file: the request, the optical constants, the versions of the
/// code.
std::string describe(const TableRequest& request);

/// A leaf's part of that.
std::string describe(const TissueParams& params);
/// Evenly spaced numbers in short, others one by one.
std::string list_text(const std::vector<double>& values);

/// One line for people: what the table holds and how good it is.
std::string summary(const TableRequest& request, std::string_view name, const Table& table);

/// A table's file with a checksum at its end.
std::string seal(const Table& table, std::string_view header);
/// What `seal` wrote under the same header; false if it is anything else.
bool unseal(std::string_view text, std::string_view header, Table& table);

}  // namespace frond::leaf
