#include "materials/registry.h"

#include <array>

namespace frond {

extern const MaterialInfo abm_material;
extern const MaterialInfo diffuse_material;
extern const MaterialInfo diffuse_transmission_material;
extern const MaterialInfo leaf_material;
extern const MaterialInfo leaf_lambert_material;
extern const MaterialInfo leaf_simplified_material;
extern const MaterialInfo leaf_solved_material;
extern const MaterialInfo mix_material;

std::span<const MaterialInfo* const> builtin_materials() {
  static constexpr std::array table{
      &abm_material,          &diffuse_material,         &diffuse_transmission_material, &leaf_material,
      &leaf_lambert_material, &leaf_simplified_material, &leaf_solved_material,          &mix_material,
  };
  return table;
}

}  // namespace frond
