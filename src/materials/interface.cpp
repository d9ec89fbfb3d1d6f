#include "core/material.h"

namespace frond {
namespace {

// A path continues straight through a surface without a BSDF.
class Interface final : public Material {
 public:
  explicit Interface(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
  bool is_reciprocal() const override { return true; }
};

}  // namespace

extern const MaterialInfo interface_material{
    {"material",
     "interface",
     "Invisible surface, such as the boundary of a medium. It blocks shadow rays of path, not those of volpath.",
     "pbrt-v4",
     {}},
    make_material<Interface>};

}  // namespace frond
