#pragma once

#include <optional>

#include "core/log.h"
#include "leaf/table/leaf_file.h"
#include "materials/leaf_params.h"

namespace frond {

/// Input of `make_leaf_file`.
struct LeafFileRequest {
  std::vector<double> wavelengths_nm;   ///< in any order
  double tolerance;                     ///< largest error of pi f, as leaf_solved's parameter
  std::optional<Interval> depths = {};  ///< optical depths of the mesophyll; none: the leaf's own at each wavelength
  int nodes = 0;                        ///< per segment; 0: as many as the tolerance needs
};

/// Returns a leaf_solved as plain arrays for other programs (docs/file_formats.md). Its mode table is cached in
/// `cache_dir` (empty: no cache). Throws InputError for incident "light", wavelengths without optical constants, and an
/// invalid range of depths.
leaf::LeafFile make_leaf_file(const LeafParams& leaf, LeafFileRequest request, const ThreadPool& pool, const Log& log,
                              const std::filesystem::path& cache_dir);

}  // namespace frond
