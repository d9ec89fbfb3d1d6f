#include "materials/registry.h"

#include <array>

namespace frond {

extern const MaterialInfo diffuse_material;
extern const MaterialInfo diffuse_transmission_material;
extern const MaterialInfo mix_material;

std::span<const MaterialInfo* const> builtin_materials() {
  static constexpr std::array table{
      &diffuse_material,
      &diffuse_transmission_material,
      &mix_material,
  };
  return table;
}

}  // namespace frond
