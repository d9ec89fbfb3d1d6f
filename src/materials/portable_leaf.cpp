#include "materials/portable_leaf.h"

#include "leaf/table/mode_table_cache.h"
#include "leaf/table/reciprocal_modes.h"
#include "leaf/tissue/constants.h"

namespace frond {

leaf::PortableLeaf make_portable_leaf(const LeafParams& leaf, PortableLeafRequest request, const ThreadPool& pool,
                                      const Log& log, const std::filesystem::path& cache_dir) {
  if (leaf.incident() == Incident::light)
    fail({},
         "a .leaf file is of incident \"traced\" or \"reciprocal\": \"light\" is the former with its directions "
         "swapped");
  if (request.wavelengths_nm.empty()) fail({}, "a .leaf file needs wavelengths");
  for (const double nm : request.wavelengths_nm)
    if (!leaf::kConstantsRange_nm.contains(nm))
      fail({}, "leaf optics are known from {} to {} nm, {} was given", leaf::kConstantsRange_nm.min,
           leaf::kConstantsRange_nm.max, nm);
  std::ranges::sort(request.wavelengths_nm);
  leaf::ModeTableRequest body{.params = leaf.tissue(),
                              .wavelengths_nm = request.wavelengths_nm,
                              .tolerance = request.tolerance / (leaf.is_reciprocal() ? leaf::kReciprocalFiner : 1),
                              .nodes = request.nodes};
  body.params.cuticle_aspect = 0;  // the surface is not part of the modes
  if (request.depths) {
    const auto [least, most] = *request.depths;
    if (!(0 <= least && least < most)) fail({}, "depths from {} to {} are no range from 0 on", least, most);
    body.depths = leaf::DepthAxis(least, most, leaf::kDepthStep);
  }
  leaf::ModeTable spectrum = leaf::cached_mode_table(body, leaf.specimen(), pool, log, cache_dir);
  if (leaf.is_reciprocal()) spectrum = leaf::make_reciprocal(spectrum).value();
  return leaf::make_portable(body, spectrum, leaf.tissue().cuticle_aspect);
}

}  // namespace frond
