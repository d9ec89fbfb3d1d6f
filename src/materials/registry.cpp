#include "materials/registry.h"

#include <algorithm>
#include <array>
#include <vector>

namespace frond {

extern const MaterialInfo abm_material;
extern const MaterialInfo coated_conductor_material;
extern const MaterialInfo coated_diffuse_material;
extern const MaterialInfo conductor_material;
extern const MaterialInfo dielectric_material;
extern const MaterialInfo diffuse_material;
extern const MaterialInfo diffuse_transmission_material;
extern const MaterialInfo hair_material;
extern const MaterialInfo interface_material;
extern const MaterialInfo leaf_lambert_material;
extern const MaterialInfo leaf_simplified_material;
extern const MaterialInfo leaf_solved_material;
extern const MaterialInfo measured_material;
extern const MaterialInfo mix_material;
extern const MaterialInfo subsurface_material;
extern const MaterialInfo thin_dielectric_material;

namespace {

constexpr std::array kMaterials{
    &abm_material,
    &coated_conductor_material,
    &coated_diffuse_material,
    &conductor_material,
    &dielectric_material,
    &diffuse_material,
    &diffuse_transmission_material,
    &hair_material,
    &interface_material,
    &leaf_lambert_material,
    &leaf_simplified_material,
    &leaf_solved_material,
    &measured_material,
    &mix_material,
    &subsurface_material,
    &thin_dielectric_material,
};

}  // namespace

// docs/plugins.md and the lists of the command line keep the order by name.
std::span<const MaterialInfo* const> builtin_materials() {
  static const auto table = [] {
    std::vector<const MaterialInfo*> materials(kMaterials.begin(), kMaterials.end());
    materials.push_back(&open_leaf_of(kMaterials));
    std::ranges::sort(materials, {}, &MaterialInfo::name);
    return materials;
  }();
  return table;
}

}  // namespace frond
