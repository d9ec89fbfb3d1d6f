#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "assimp/scene_conversion.h"

namespace frond {
namespace {

/// Returns a number of the material, or `otherwise` if it is not given or not finite.
float number(const aiMaterial& m, const char* key, unsigned type, unsigned index, float otherwise) {
  float value = 0;
  const bool given = aiGetMaterialFloat(&m, key, type, index, &value) == aiReturn_SUCCESS;
  return given && std::isfinite(value) ? value : otherwise;
}

/// Returns the index of an image; adds it unless it is there. The name of an embedded image begins with *.
int32_t image_index(const std::string& name, const aiScene& scene, std::vector<ImportedImage>& images) {
  ImportedImage image{name, {}, {}};
  if (const aiTexture* embedded = scene.GetEmbeddedTexture(name.c_str()); embedded && embedded->mHeight == 0) {
    image.extension = embedded->achFormatHint;
    if (image.extension == "jpg") image.extension = "jpeg";
    const std::string own = embedded->mFilename.C_Str();
    image.name = own.empty() ? "image" + (name.starts_with('*') ? name.substr(1) : "") : own;
    const auto* bytes = reinterpret_cast<const unsigned char*>(embedded->pcData);
    image.bytes.assign(bytes, bytes + embedded->mWidth);
  }
  const auto found = std::ranges::find(images, image);
  if (found != images.end()) return int32_t(found - images.begin());
  images.push_back(std::move(image));
  return int32_t(images.size() - 1);
}

/// Returns glTF's transform of texture coordinates (KHR_texture_transform). The library has turned offset and rotation
/// into others, about the centre of the image; this inverts it. v is 0 at an image's lower edge here, at the upper one
/// in glTF.
std::array<float, 6> to_image(const aiUVTransform& given) {
  const float sx = given.mScaling.x, sy = given.mScaling.y;
  const float c = std::cos(given.mRotation), s = std::sin(-given.mRotation);
  const float x = given.mTranslation.x - 0.5f * sx * (1 - c + s);
  const float y = 0.5f * sy * (s + c - 1) + 1 - sy - given.mTranslation.y;
  // u' = c sx u + s sy (1 - v) + x, 1 - v' = -s sx u + c sy (1 - v) + y
  return {c * sx, -s * sy, s * sy + x, s * sx, c * sy, 1 - c * sy - y};
}

/// Returns the first texture of a type. The wrap mode along u is used for both directions.
ImportedTexture texture(const aiMaterial& m, aiTextureType type, const aiScene& scene,
                        std::vector<ImportedImage>& images) {
  using Wrap = ImportedTexture::Wrap;
  aiString path;
  if (m.GetTextureCount(type) == 0 || m.Get(AI_MATKEY_TEXTURE(type, 0), path) != aiReturn_SUCCESS) return {};
  ImportedTexture t{.image = image_index(path.C_Str(), scene, images)};
  int uv = 0, mode = aiTextureMapMode_Wrap;
  if (m.Get(AI_MATKEY_UVWSRC(type, 0), uv) == aiReturn_SUCCESS && uv > 0) t.uv_set = unsigned(uv);
  aiUVTransform transform;
  if (m.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS) t.to_image = to_image(transform);
  if (m.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode) == aiReturn_SUCCESS)
    t.wrap = mode == aiTextureMapMode_Clamp    ? Wrap::clamp
             : mode == aiTextureMapMode_Mirror ? Wrap::mirror
                                               : Wrap::repeat;
  return t;
}

/// Whether the colour is from glTF's KHR_materials_pbrSpecularGlossiness, which replaces the base colour.
bool is_specular_glossy(const aiMaterial& m) {
  float glossiness = 0;
  return m.Get(AI_MATKEY_GLOSSINESS_FACTOR, glossiness) == aiReturn_SUCCESS;
}

/// glTF's base colour, or the diffuse colour of its extension and of other formats.
std::array<float, 3> base_color(const aiMaterial& m) {
  aiColor4D c(0.5f, 0.5f, 0.5f, 1);
  if (is_specular_glossy(m) || m.Get(AI_MATKEY_BASE_COLOR, c) != aiReturn_SUCCESS) m.Get(AI_MATKEY_COLOR_DIFFUSE, c);
  std::array<float, 3> color{c.r, c.g, c.b};
  for (float& v : color) v = std::isfinite(v) ? std::clamp(v, 0.f, 1.f) : 0.5f;
  return color;
}

/// glTF's opacity is the alpha of its base colour.
float opacity_of(const aiMaterial& m, bool is_gltf) {
  aiColor4D c;
  float opacity = number(m, AI_MATKEY_OPACITY, 1);
  const bool is_glossy = is_specular_glossy(m);
  const aiReturn found = is_glossy ? m.Get(AI_MATKEY_COLOR_DIFFUSE, c) : m.Get(AI_MATKEY_BASE_COLOR, c);
  if (is_gltf && found == aiReturn_SUCCESS && std::isfinite(c.a)) opacity = c.a;
  return std::clamp(opacity, 0.f, 1.f);
}

/// Only glTF has alpha modes; the opacity of other formats is used unchanged.
ImportedMaterial::Alpha alpha_of(const aiMaterial& m) {
  using enum ImportedMaterial::Alpha;
  aiString mode;
  if (m.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS) return blend;
  return std::strcmp(mode.C_Str(), "MASK") == 0 ? mask : std::strcmp(mode.C_Str(), "BLEND") == 0 ? blend : opaque;
}

}  // namespace

/// A map of metalness and roughness multiplies the factors, so that these alone say nothing: the surface is taken as
/// no metal then.
ImportedMaterial converted(const aiMaterial& material, const aiScene& scene, std::vector<ImportedImage>& images) {
  ImportedMaterial m;
  aiString name, alpha_mode;
  material.Get(AI_MATKEY_NAME, name);
  m.name = name.C_Str();
  const bool is_gltf = material.Get(AI_MATKEY_GLTF_ALPHAMODE, alpha_mode) == aiReturn_SUCCESS;
  const bool has_roughness_image = is_gltf && (material.GetTextureCount(aiTextureType_UNKNOWN) > 0 ||
                                               material.GetTextureCount(aiTextureType_METALNESS) > 0 ||
                                               material.GetTextureCount(aiTextureType_DIFFUSE_ROUGHNESS) > 0);
  m.color = base_color(material);
  m.opacity = opacity_of(material, is_gltf);
  m.alpha = alpha_of(material);
  m.cutoff = number(material, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f);
  const bool is_glossy = is_specular_glossy(material);
  const bool has_base = !is_glossy && material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
  m.color_texture = texture(material, has_base ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE, scene, images);
  m.opacity_texture = texture(material, aiTextureType_OPACITY, scene, images);
  // The image of an OBJ replaces its colour, which exporters set to any value beside an image, black too.
  if (!is_gltf && m.color_texture.image >= 0) m.color = {1, 1, 1};
  m.normal_texture = texture(material, aiTextureType_NORMALS, scene, images);
  if (is_gltf && !is_glossy && !has_roughness_image) {
    m.roughness = std::clamp(number(material, AI_MATKEY_ROUGHNESS_FACTOR, 1), 0.f, 1.f);
    // Both factors are 1 where a file does not state them, which is no statement about metal.
    const float metalness = number(material, AI_MATKEY_METALLIC_FACTOR, 1);
    m.metalness = metalness == 1 && m.roughness == 1 ? 0 : metalness;
  }
  return m;
}

}  // namespace frond
