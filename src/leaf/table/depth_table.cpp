#include "leaf/table/depth_table.h"

#include <algorithm>

namespace frond::leaf {

DepthTable make_depth_table(const TissueModel& model, const std::vector<double>& theta_deg,
                            const std::vector<double>& wavelengths_nm, const DepthAxis& depths,
                            const ThreadPool& pool) {
  constexpr size_t kBlock = 16;  // depths that share one solver's matrices
  const std::vector<double>& all = depths.depths();
  const size_t blocks = (all.size() + kBlock - 1) / kBlock, angles = theta_deg.size();
  DepthTable table{theta_deg, wavelengths_nm, depths};
  table.shares.resize(wavelengths_nm.size() * all.size() * angles);
  pool.for_each(static_cast<int64_t>(wavelengths_nm.size() * blocks), [&](int64_t index, int) {
    const size_t w = static_cast<size_t>(index) / blocks, first = static_cast<size_t>(index) % blocks * kBlock;
    std::vector<Tissue> tissues;
    for (size_t d = first; d < std::min(first + kBlock, all.size()); ++d)
      tissues.push_back(model.at(wavelengths_nm[w], all[d], model.lobes()));
    auto place = table.shares.begin() + static_cast<ptrdiff_t>((w * all.size() + first) * angles);
    for (const std::vector<Shares>& column : solve_depths(tissues, theta_deg))
      place = std::copy(column.begin(), column.end(), place);
  });
  return table;
}

}  // namespace frond::leaf
