#include "spectra/wavelengths/band_preview.h"

#include <map>
#include <vector>

#include "core/fluorescence.h"
#include "spectra/cie.h"

namespace frond {

std::vector<Triple> xyz_of_bands(std::span<const Band> bands) {
  std::map<double, std::vector<size_t>> at;  // indices of the bands by wavelength, ascending
  for (size_t i = 0; i < bands.size(); ++i)
    if (!is_of_fluorescence(bands[i])) at[bands[i].nm].push_back(i);
  if (at.size() < 4 || at.begin()->first > 450 || at.rbegin()->first < 650) return {};
  std::vector<Triple> weights(bands.size());
  auto above = at.begin();  // first band at or above nm
  constexpr double kStep_nm = 0.1;
  const auto add = [&](const auto& place, double share, const Triple& bar) {
    for (const size_t i : place->second)
      for (size_t c = 0; c < 3; ++c) weights[i][c] += share * bar[c] * kStep_nm / double(place->second.size());
  };
  for (double nm = kCieRange_nm.min + kStep_nm / 2; nm < kCieRange_nm.max; nm += kStep_nm) {
    while (above != at.end() && above->first < nm) ++above;
    const auto b = above == at.end() ? std::prev(above) : above, a = above == at.begin() ? above : std::prev(above);
    const double t = a == b ? 0 : (nm - a->first) / (b->first - a->first);
    const Triple bar = cie_xyz(nm);
    add(a, 1 - t, bar), add(b, t, bar);
  }
  return weights;
}

}  // namespace frond
