#include "render/light_white.h"

#include <map>

#include "spectra/cie.h"

namespace frond {

/// Triangles of an emitting mesh are lights of one spectrum, whose integral is computed once.
std::optional<Chromaticity> light_white(const World& world) {
  std::map<const Spectrum*, double> powers;
  for (const Light* light : world.lights()) powers[&light->emission()] += light->power(world.radius());
  double x = 0, y = 0, all = 0;
  for (const Light* light : world.lights()) {  // in the order of the scene: sums have the same bits each time
    const auto found = powers.find(&light->emission());
    if (found == powers.end()) continue;
    const Triple xyz = to_xyz(*found->first);
    if (xyz[1] > 0) {
      const double weight = found->second / xyz[1];
      x += weight * xyz[0], y += weight * xyz[1], all += weight * (xyz[0] + xyz[1] + xyz[2]);
    }
    powers.erase(found);
  }
  if (!(y > 0) || !(all > 0)) return {};
  return Chromaticity{x / all, y / all};
}

}  // namespace frond
