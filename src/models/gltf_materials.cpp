#include "models/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace frond {
namespace {

using Json = nlohmann::json;

/// Returns the colour of the first three factors, limited to reflectances.
std::array<float, 3> color_of(const std::vector<double>& c) {
  std::array<float, 3> color{};
  for (size_t i = 0; i < 3; ++i) color[i] = std::clamp(float(c[i]), 0.f, 1.f);
  return color;
}

/// Returns a number of an object within 0 and 1.
float fraction(const Json& object, std::string_view key, double otherwise) {
  return std::clamp(float(number(object, key, otherwise)), 0.f, 1.f);
}

/// Returns the map of texture coordinates by KHR_texture_transform, about the upper left corner of the image. v is 0 at
/// the lower edge here, at the upper one in glTF: u' = c sx u + s sy (1 - v) + x, 1 - v' = -s sx u + c sy (1 - v) + y.
std::array<float, 6> to_image(const Json& transform) {
  const auto scale = numbers(transform, "scale", {1, 1}), offset = numbers(transform, "offset", {0, 0});
  const double angle = number(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  return {float(c * scale[0]), float(-s * scale[1]), float(s * scale[1] + offset[0]),
          float(s * scale[0]), float(c * scale[1]),  float(1 - c * scale[1] - offset[1])};
}

}  // namespace

/// The specification's default material is white.
uint32_t GltfMaterials::index_of(std::optional<uint64_t> index) {
  const Json* material = element(document_, "materials", index);
  if (!material) index.reset();
  const auto [known, is_new] = materials_.try_emplace(index, uint32_t(scene_.materials.size()));
  if (is_new)
    scene_.materials.push_back(material ? read(*material)
                                        : ImportedMaterial{.name = "DefaultMaterial", .color = {1, 1, 1}});
  return known->second;
}

/// A normal map has the filter and wrap mode of the scene's.
ImportedMaterial GltfMaterials::read(const Json& material) {
  ImportedMaterial m{.name = std::string(text(material, "name"))};
  name_ = m.name.empty() ? m.name = "unnamed" : m.name;
  losses_.check("material", material, &name_);
  const std::string_view mode = text(material, "alphaMode");
  m.alpha = mode == "MASK"    ? ImportedMaterial::Alpha::mask
            : mode == "BLEND" ? ImportedMaterial::Alpha::blend
                              : ImportedMaterial::Alpha::opaque;
  m.cutoff = float(number(material, "alphaCutoff", 0.5));
  const Json* sides = member(material, "doubleSided");
  m.has_two_sides = sides && *sides == true;
  read_base(material, m);
  read_transmission(material, m);
  read_emission(material, m);
  m.normal_texture = texture(material, "normalTexture");
  if (m.normal_texture.image >= 0) {
    m.normal_scale.fill(float(number(*member(material, "normalTexture"), "scale", 1)));
    if (m.normal_texture.wrap != ImportedTexture::Wrap::repeat)
      losses_.add("wrap mode of the normal map", &name_, false);
  }
  return m;
}

/// Unlit surfaces are lit, as diffuse ones: their colour is that of a photograph in most models of plants.
/// A map of metalness and roughness multiplies the factors, so that these alone say nothing: the surface is taken as no
/// metal then. Both factors are 1 where a file does not state them, which is no statement about metal either.
void GltfMaterials::read_base(const Json& material, ImportedMaterial& m) {
  static const Json kNone = Json::object();
  const Json* glossy = extension(material, "KHR_materials_pbrSpecularGlossiness");
  const Json* rough = member(material, "pbrMetallicRoughness");
  const Json& base = glossy ? *glossy : rough ? *rough : kNone;
  const auto color = numbers(base, glossy ? "diffuseFactor" : "baseColorFactor", {1, 1, 1, 1});
  m.color = color_of(color);
  m.opacity = std::clamp(float(color[3]), 0.f, 1.f);
  m.color_texture = texture(base, glossy ? "diffuseTexture" : "baseColorTexture");
  if (glossy) return losses_.add("gloss", &name_);
  if (extension(material, "KHR_materials_unlit"))
    return losses_.add("shading without light (KHR_materials_unlit)", &name_);
  losses_.check("pbrMetallicRoughness", base, &name_);
  if (!rough || member(base, "metallicRoughnessTexture")) return;
  const float metalness = fraction(base, "metallicFactor", 1);
  m.roughness = fraction(base, "roughnessFactor", 1);
  m.metalness = metalness == 1 && m.roughness == 1 ? 0 : metalness;
  const Json* clear = extension(material, "KHR_materials_transmission");
  const Json* specular = extension(material, "KHR_materials_specular");
  const bool is_clear = clear && fraction(*clear, "transmissionFactor", 0) >= 0.5f;
  const bool is_matt = m.roughness == 1 || (specular && fraction(*specular, "specularFactor", 1) == 0);
  if (metalness < 0.5f && !is_matt && !is_clear) losses_.add("gloss", &name_);
  if (metalness > 0 && metalness < 1) losses_.add("metalness between 0 and 1 (metallicFactor)", &name_);
  if (metalness == 1 && m.roughness == 1 && member(base, "metallicFactor"))
    losses_.add("metalness of a roughness of 1 (metallicFactor)", &name_);
}

/// Diffuse transmission, or a clear surface: one that transmits less than half of its light is taken as opaque.
void GltfMaterials::read_transmission(const Json& material, ImportedMaterial& m) {
  if (const Json* diffuse = extension(material, "KHR_materials_diffuse_transmission")) {
    m.transmission = fraction(*diffuse, "diffuseTransmissionFactor", 0);
    m.transmitted = color_of(numbers(*diffuse, "diffuseTransmissionColorFactor", {1, 1, 1}));
    m.transmission_texture = texture(*diffuse, "diffuseTransmissionTexture");
    m.transmitted_texture = texture(*diffuse, "diffuseTransmissionColorTexture");
  }
  const Json* ior = extension(material, "KHR_materials_ior");
  const double eta = ior ? number(*ior, "ior", 1.5) : 1.5;
  const Json* clear = extension(material, "KHR_materials_transmission");
  const float share = clear ? fraction(*clear, "transmissionFactor", 0) : 0;
  if (share > 0 && share < 1) losses_.add("transmission between 0 and 1 (transmissionFactor)", &name_);
  if (share < 0.5f || m.metalness >= 0.5f) {
    if (eta != 1.5) losses_.add("index of refraction (KHR_materials_ior)", &name_);
    return;
  }
  const Json* volume = extension(material, "KHR_materials_volume");
  m.ior = eta >= 1 ? float(eta) : 1.5f;
  m.thickness = volume ? std::max(float(number(*volume, "thicknessFactor", 0)), 0.f) : 0;
  if (m.color != std::array<float, 3>{1, 1, 1} || m.color_texture.image >= 0)
    losses_.add("colour of a clear surface", &name_);
  if (m.thickness == 0 && m.roughness > 0) losses_.add("roughness of a thin clear surface", &name_);
}

/// The factor is black by default, which no texture makes brighter.
void GltfMaterials::read_emission(const Json& material, ImportedMaterial& m) {
  const Json* strength = extension(material, "KHR_materials_emissive_strength");
  const double scale = strength ? number(*strength, "emissiveStrength", 1) : 1;
  const auto factor = numbers(material, "emissiveFactor", {0, 0, 0});
  for (size_t i = 0; i < 3; ++i) m.emission[i] = std::max(float(factor[i] * scale), 0.f);
  if (m.is_emitter()) m.emission_texture = texture(material, "emissiveTexture");
}

/// A texture has one wrap mode for both directions in the scene: that along u.
ImportedTexture GltfMaterials::texture(const Json& object, std::string_view key) {
  using Wrap = ImportedTexture::Wrap;
  constexpr uint64_t kRepeat = 10497, kClamp = 33071, kMirror = 33648;
  const Json* use = member(object, key);
  if (!use) return {};
  losses_.check("textureInfo", *use, &name_);
  ImportedTexture t{.uv_set = uint32_t(integer(*use, "texCoord").value_or(0))};
  if (const Json* transform = extension(*use, "KHR_texture_transform")) {
    t.uv_set = uint32_t(integer(*transform, "texCoord").value_or(t.uv_set));
    t.to_image = to_image(*transform);
  }
  const Json* texture = element(document_, "textures", integer(*use, "index"));
  if (!texture) {
    losses_.add("image of a texture that does not exist", &name_, false);
    return {};
  }
  losses_.check("texture", *texture, &name_);
  t.image = image_of(*texture);
  const Json* sampler = element(document_, "samplers", integer(*texture, "sampler"));
  if (!sampler) return t;
  losses_.check("sampler", *sampler, &name_);
  const uint64_t u = integer(*sampler, "wrapS").value_or(kRepeat);
  if (u != integer(*sampler, "wrapT").value_or(kRepeat)) losses_.add("wrap mode along v (wrapT)", &name_, false);
  t.wrap = u == kClamp ? Wrap::clamp : u == kMirror ? Wrap::mirror : Wrap::repeat;
  return t;
}

/// WebP replaces the image in another format.
int32_t GltfMaterials::image_of(const Json& texture) {
  const Json* webp = extension(texture, "EXT_texture_webp");
  const auto index = integer(webp ? *webp : texture, "source");
  const Json* image = element(document_, "images", index);
  if (!image) {
    losses_.add("image of a texture without source", &name_, false);
    return -1;
  }
  losses_.check("image", *image, &name_);
  const auto [known, is_new] = images_.try_emplace(*index, int32_t(scene_.images.size()));
  if (!is_new) return known->second;
  const std::string_view uri = text(*image, "uri"), name = text(*image, "name");
  ImportedImage result{
      .name = name.empty() ? "image" + std::to_string(*index) : std::string(name), .bytes = {}, .extension = {}};
  std::string type(text(*image, "mimeType"));
  if (auto data = GltfData::embedded(uri)) {
    result.bytes.assign(data->second.begin(), data->second.end());
    if (type.empty()) type = data->first;
  } else if (const auto view = integer(*image, "bufferView")) {
    const std::string_view bytes = data_.view(*view, place_of("images", *index));
    result.bytes.assign(bytes.begin(), bytes.end());
  } else {
    result.name = data_.file_name(uri);
  }
  if (!result.bytes.empty()) result.extension = type.substr(std::min(type.find('/'), type.size() - 1) + 1);
  scene_.images.push_back(std::move(result));
  return known->second;
}

}  // namespace frond
