#include "materials/leaf_file.h"

#include "leaf/table/mode_table_cache.h"
#include "leaf/table/reciprocal_modes.h"
#include "leaf/tissue/constants.h"

namespace frond {

leaf::LeafFile make_leaf_file(const LeafParams& leaf, LeafFileRequest request, const ThreadPool& pool, const Log& log,
                              const std::filesystem::path& cache_dir) {
  if (leaf.incident() == Incident::light)
    fail({},
         "a .leaf file supports incident \"traced\" and \"reciprocal\"; \"light\" is \"traced\" with its directions "
         "exchanged");
  if (request.wavelengths_nm.empty()) fail({}, "a .leaf file needs wavelengths");
  for (const double nm : request.wavelengths_nm)
    if (!leaf::kConstantsRange_nm.contains(nm))
      fail({}, "leaf optics are known from {} to {} nm, {} was given", leaf::kConstantsRange_nm.min,
           leaf::kConstantsRange_nm.max, nm);
  constexpr Interval kTolerances{1e-5, 0.1};  // of leaf_solved's parameter
  if (!kTolerances.contains(request.tolerance))
    fail({}, "tolerance: a number from {} to {} is needed, {} was given", kTolerances.min, kTolerances.max,
         request.tolerance);
  std::ranges::sort(request.wavelengths_nm);
  leaf::ModeTableRequest body{.params = leaf.tissue(),
                              .wavelengths_nm = request.wavelengths_nm,
                              .tolerance = request.tolerance / (leaf.is_reciprocal() ? leaf::kReciprocalFiner : 1),
                              .nodes = request.nodes};
  body.params.cuticle_aspect = 0;  // modes do not depend on the surface's lobe
  if (request.depths) {
    const auto [least, most] = *request.depths;
    constexpr double kDeepest = 100;  // times the mean depth of a leaf
    if (!(0 <= least && least < most && most <= kDeepest))
      fail({}, "invalid range of depths, {} to {}: 0 <= least < most <= {} is required", least, most, kDeepest);
    body.depths = leaf::DepthAxis(least, most, leaf::kDepthStep);
  }
  leaf::ModeTable spectrum = leaf::cached_mode_table(body, leaf.specimen(), pool, log, cache_dir);
  if (leaf.is_reciprocal()) spectrum = leaf::make_reciprocal(spectrum).value();
  return leaf::make_leaf_file(body, spectrum, leaf.tissue().cuticle_aspect);
}

}  // namespace frond
