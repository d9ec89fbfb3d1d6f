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
     "Invisible surface: rays of a path pass straight through, shadow rays are blocked.",
     "pbrt-v4",
     {}},
    make_material<Interface>};

}  // namespace frond
