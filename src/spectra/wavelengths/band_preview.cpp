#include "spectra/wavelengths/band_preview.h"

#include <algorithm>

#include "spectra/cie.h"

namespace frond {

std::vector<Triple> xyz_of_bands(std::span<const Band> bands) {
  if (bands.size() < 4 || bands.front().nm > 450 || bands.back().nm < 650) return {};
  std::vector<Triple> weights(bands.size());
  size_t above = 0;  // first band at or above nm
  constexpr double kStep_nm = 0.1;
  for (double nm = kCieRange_nm.min + kStep_nm / 2; nm < kCieRange_nm.max; nm += kStep_nm) {
    while (above < bands.size() && bands[above].nm < nm) ++above;
    const size_t b = std::min(above, bands.size() - 1), a = above == 0 ? 0 : above - 1;
    const double t = a == b ? 0 : (nm - bands[a].nm) / (bands[b].nm - bands[a].nm);
    const Triple bar = cie_xyz(nm);
    for (size_t c = 0; c < 3; ++c) {
      weights[a][c] += (1 - t) * bar[c] * kStep_nm;
      weights[b][c] += t * bar[c] * kStep_nm;
    }
  }
  return weights;
}

}  // namespace frond
