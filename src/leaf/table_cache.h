#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table.h"

namespace frond::leaf {

/// `make_table`, kept on disk in `cache_dir` (empty: not kept) under a hash of all that it depends on. A file that is
/// damaged is made anew; one that cannot be written costs a warning. Says through `log` what it took, with `name`.
Table cached_table(const TableRequest& request, std::string_view name, const ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir);

/// Everything that a table depends on, as text: the request, the optical constants, the versions of the code.
std::string describe(const TableRequest& request);

/// CSV (theta_deg, wavelength_nm, Rs, Rd, T) with `header` and a checksum as comments; numbers read back to the bit.
std::string to_csv(const Table& table, std::string_view header);
/// What `to_csv` wrote under the same header; false if it is anything else.
bool from_csv(std::string_view text, std::string_view header, Table& table);

}  // namespace frond::leaf
