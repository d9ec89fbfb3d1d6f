#pragma once

#include <optional>

#include "core/log.h"
#include "leaf/table/portable_leaf.h"
#include "materials/leaf_params.h"

namespace frond {

struct PortableLeafRequest {
  std::vector<double> wavelengths_nm;   ///< in any order
  double tolerance;                     ///< of leaf_solved
  std::optional<Interval> depths = {};  ///< optical, of the mesophyll; none: those of the leaf at each wavelength
  int nodes = 0;                        ///< per segment; 0: as many as the tolerance needs
};

/// A leaf_solved as plain arrays for other programs (docs/leaf_file.md). Its modes are kept on disk in `cache_dir`
/// (empty: not kept). Throws InputError for incident "light", wavelengths without optical constants, and depths that
/// are no range.
leaf::PortableLeaf make_portable_leaf(const LeafParams& leaf, PortableLeafRequest request, const ThreadPool& pool,
                                      const Log& log, const std::filesystem::path& cache_dir);

}  // namespace frond
