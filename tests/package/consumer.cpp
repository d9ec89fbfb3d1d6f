#include <cstdio>

#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/registry.h"

/// Uses every library of the package, so that a missing one cannot be linked.
int main() {
  const frond::Registry registry = frond::make_registry(frond::builtin_materials(), frond::builtin_integrators());
  for (const char* name : {"abm", "leaf_simplified"})
    if (!registry.materials.find(name)) return std::fprintf(stderr, "no material %s\n", name), 1;
  return 0;
}
