#include "models/gltf_properties.h"

#include <algorithm>

namespace frond {
namespace {

using enum GltfUse;

constexpr GltfProperty kProperties[] = {
    {"glTF",
     "asset scene scenes nodes meshes materials textures images samplers accessors bufferViews buffers extensionsUsed "
     "extensionsRequired skins cameras",
     read},
    {"glTF", "animations", lost, "animation", "[]"},
    {"asset", "version minVersion", read},
    {"asset", "generator copyright", inert},
    {"scene", "nodes", read},
    {"scene", "name", inert},
    {"node", "children mesh matrix translation rotation scale name skin weights camera", read},
    {"camera", "type perspective orthographic", read},
    {"camera", "name", inert},
    // znear zfar: nothing is clipped
    {"perspective", "yfov aspectRatio", read},
    {"perspective", "znear zfar", inert},
    {"orthographic", "xmag ymag", read},
    {"orthographic", "znear zfar", inert},
    {"KHR_lights_punctual", "light", read},
    {"light", "type color intensity spot", read},
    // range: a hint to leave out the light beyond
    {"light", "range name", inert},
    {"spot", "innerConeAngle outerConeAngle", read},
    {"mesh", "primitives weights name", read},
    {"primitive", "attributes indices material mode targets", read},
    // TANGENT: its sign; a direction that differs from that of u is named
    {"attributes", "POSITION NORMAL TEXCOORD_* TANGENT JOINTS_* WEIGHTS_* COLOR_0", read},
    {"attributes", "COLOR_*", lost, "further vertex colours (COLOR_1)"},
    // _*: of applications
    {"attributes", "_*", inert},
    {"skin", "joints inverseBindMatrices", read},
    {"skin", "skeleton name", inert},
    {"EXT_mesh_gpu_instancing", "attributes", read},
    {"instances", "TRANSLATION ROTATION SCALE", read},
    // _*: of applications
    {"instances", "_*", inert},
    // doubleSided: of surfaces that emit; all others have two sides
    {"material",
     "name pbrMetallicRoughness normalTexture alphaMode alphaCutoff emissiveFactor emissiveTexture doubleSided", read},
    {"material", "occlusionTexture", surface, "occlusion map (occlusionTexture)"},
    // metallicFactor: what has no counterpart is named as gloss or metalness
    {"pbrMetallicRoughness", "baseColorFactor baseColorTexture metallicFactor roughnessFactor", read},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", surface, "roughness and metalness map"},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseFactor diffuseTexture", read},
    // specularFactor: the gloss is named
    {"KHR_materials_pbrSpecularGlossiness", "specularFactor glossinessFactor", inert},
    {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", surface, "specular map"},
    // scale: of normalTexture only
    {"textureInfo", "index texCoord scale", read},
    {"KHR_texture_transform", "offset rotation scale texCoord", read},
    {"KHR_materials_diffuse_transmission", "diffuseTransmission*", read},
    // specularFactor: 0 is a surface without gloss
    {"KHR_materials_specular", "specularFactor", read},
    {"KHR_materials_specular", "specularColorFactor", surface, "colour of the gloss (specularColorFactor)", "[1,1,1]"},
    {"KHR_materials_specular", "specularTexture specularColorTexture", surface, "specular map"},
    {"KHR_materials_transmission", "transmissionFactor", read},
    {"KHR_materials_transmission", "transmissionTexture", surface, "transmission map"},
    {"KHR_materials_ior", "ior", read},
    {"KHR_materials_volume", "thicknessFactor", read},
    // attenuationColor: with attenuationDistance
    {"KHR_materials_volume", "thicknessTexture attenuationColor", inert},
    {"KHR_materials_volume", "attenuationDistance", surface, "absorption inside a volume (attenuationDistance)"},
    {"KHR_materials_emissive_strength", "emissiveStrength", read},
    {"EXT_texture_webp", "source", read},
    {"texture", "source sampler", read},
    {"texture", "name", inert},
    // wrapT: reported if it differs from wrapS
    {"sampler", "wrapS wrapT", read},
    {"sampler", "magFilter", lost, "filter NEAREST of images (magFilter)", "9729"},
    {"sampler", "minFilter name", inert},
    {"image", "uri bufferView mimeType name", read},
};

/// Required ones are no error.
constexpr std::string_view kRead[] = {
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_unlit",
    "KHR_lights_punctual",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
#ifdef FROND_HAS_MESHOPTIMIZER
    "EXT_meshopt_compression",
#endif
};

/// Whether a name is one of a record's, or begins like one that ends with *.
bool has_name(const GltfProperty& property, std::string_view name) {
  std::string_view rest = property.names;
  while (!rest.empty()) {
    const std::string_view pattern = rest.substr(0, rest.find(' '));
    if (pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern) return true;
    rest.remove_prefix(std::min(pattern.size() + 1, rest.size()));
  }
  return false;
}

}  // namespace

std::span<const GltfProperty> gltf_properties() { return kProperties; }

const GltfProperty* gltf_property(std::string_view object, std::string_view name) {
  const auto* found =
      std::ranges::find_if(kProperties, [&](const GltfProperty& p) { return p.object == object && has_name(p, name); });
  return found == std::end(kProperties) ? nullptr : found;
}

bool is_read_extension(std::string_view name) { return std::ranges::find(kRead, name) != std::end(kRead); }

}  // namespace frond
