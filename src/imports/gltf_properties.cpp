#include "imports/gltf_properties.h"

#include <algorithm>

namespace frond {
namespace {

using enum GltfUse;

constexpr GltfProperty kProperties[] = {
    {"glTF", "asset", read},
    {"glTF", "scene", read},
    {"glTF", "scenes", read},
    {"glTF", "nodes", read},
    {"glTF", "meshes", read},
    {"glTF", "materials", read},
    {"glTF", "textures", read},
    {"glTF", "images", read},
    {"glTF", "samplers", read},
    {"glTF", "accessors", read},
    {"glTF", "bufferViews", read},
    {"glTF", "buffers", read},
    {"glTF", "extensionsUsed", read},
    {"glTF", "extensionsRequired", read},
    {"glTF", "cameras", inert},  // those that nodes have are named
    {"glTF", "skins", inert},    // meshes that have one are refused
    {"glTF", "animations", lost, "animation", "[]"},
    {"asset", "version", read},
    {"asset", "minVersion", read},
    {"asset", "generator", inert},
    {"asset", "copyright", inert},
    {"scene", "nodes", read},
    {"scene", "name", inert},
    {"node", "children", read},
    {"node", "mesh", read},
    {"node", "matrix", read},
    {"node", "translation", read},
    {"node", "rotation", read},
    {"node", "scale", read},
    {"node", "name", read},
    {"node", "skin", read},     // refused with a mesh
    {"node", "weights", read},  // refused unless they are 0
    {"node", "camera", lost, "camera"},
    {"mesh", "primitives", read},
    {"mesh", "weights", read},  // refused unless they are 0
    {"mesh", "name", read},
    {"primitive", "attributes", read},
    {"primitive", "indices", read},
    {"primitive", "material", read},
    {"primitive", "mode", read},
    {"primitive", "targets", lost, "morph targets", "[]"},
    {"attributes", "POSITION", read},
    {"attributes", "NORMAL", read},
    {"attributes", "TEXCOORD_*", read},
    {"attributes", "TANGENT", read},  // named where it has an effect, beside a normal map
    {"attributes", "COLOR_*", lost, "vertex colours (COLOR_0)"},
    {"attributes", "JOINTS_*", inert},  // without a skin
    {"attributes", "WEIGHTS_*", inert},
    {"attributes", "_*", inert},  // of applications
    {"material", "name", read},
    {"material", "pbrMetallicRoughness", read},
    {"material", "normalTexture", read},
    {"material", "alphaMode", read},
    {"material", "alphaCutoff", read},
    {"material", "doubleSided", inert},  // all surfaces have two sides
    {"material", "occlusionTexture", surface, "occlusion map (occlusionTexture)"},
    {"material", "emissiveFactor", surface, "emission", "[0,0,0]"},
    {"material", "emissiveTexture", inert},  // multiplied by the factor
    {"pbrMetallicRoughness", "baseColorFactor", read},
    {"pbrMetallicRoughness", "baseColorTexture", read},
    {"pbrMetallicRoughness", "metallicFactor", read},  // what has no counterpart is named as gloss or metalness
    {"pbrMetallicRoughness", "roughnessFactor", read},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", surface, "roughness and metalness map"},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseFactor", read},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseTexture", read},
    {"KHR_materials_pbrSpecularGlossiness", "specularFactor", inert},  // the gloss is named
    {"KHR_materials_pbrSpecularGlossiness", "glossinessFactor", inert},
    {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", surface, "specular map"},
    {"textureInfo", "index", read},
    {"textureInfo", "texCoord", read},
    {"textureInfo", "scale", lost, "scale of the normal map (normalTexture.scale)", "1"},  // of normalTexture only
    {"KHR_texture_transform", "offset", read},
    {"KHR_texture_transform", "rotation", read},
    {"KHR_texture_transform", "scale", read},
    {"KHR_texture_transform", "texCoord", read},  // named where it has an effect
    {"texture", "source", read},
    {"texture", "sampler", read},
    {"texture", "name", inert},
    {"sampler", "wrapS", read},
    {"sampler", "wrapT", read},  // reported if it differs from wrapS
    {"sampler", "magFilter", lost, "filter NEAREST of images (magFilter)", "9729"},
    {"sampler", "minFilter", inert},
    {"sampler", "name", inert},
    {"image", "uri", read},
    {"image", "bufferView", read},
    {"image", "mimeType", read},
    {"image", "name", read},
};

/// Required ones are no error.
constexpr std::string_view kRead[] = {"KHR_texture_transform", "KHR_materials_pbrSpecularGlossiness"};

bool matches_pattern(std::string_view pattern, std::string_view name) {
  return pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern;
}

}  // namespace

std::span<const GltfProperty> gltf_properties() { return kProperties; }

const GltfProperty* gltf_property(std::string_view object, std::string_view name) {
  const auto* found = std::ranges::find_if(
      kProperties, [&](const GltfProperty& p) { return p.object == object && matches_pattern(p.name, name); });
  return found == std::end(kProperties) ? nullptr : found;
}

bool is_read_extension(std::string_view name) { return std::ranges::find(kRead, name) != std::end(kRead); }

}  // namespace frond
