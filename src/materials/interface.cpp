#include "core/material.h"

namespace frond {
namespace {

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
     "A surface that is not there: rays of a path go straight on, shadow rays stop.",
     "pbrt-v4",
     {}},
    make_material<Interface>};

}  // namespace frond
