#include "integrators/registry.h"

#include <array>

namespace frond {

extern const IntegratorInfo path_integrator, volpath_integrator;

std::span<const IntegratorInfo* const> builtin_integrators() {
  static constexpr std::array table{&path_integrator, &volpath_integrator};
  return table;
}

}  // namespace frond
