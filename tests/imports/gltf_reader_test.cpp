#include "models/gltf_reader.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "models/gltf_properties.h"
#include "tests/imports/model_test.h"

namespace frond {
namespace {

using Json = nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pointwise;
using ::testing::UnorderedElementsAre;

/// A quadrilateral, 1 x 1: positions, texture coordinates (v down), indices.
std::string quad() {
  return bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + bytes_of<float>({0, 1, 1, 1, 1, 0, 0, 0}) +
         bytes_of<uint16_t>({0, 1, 2, 0, 2, 3});
}

/// The quadrilateral with a material "leaf" and an image: all of it is read.
Json model() {
  return Json::parse(
      R"({"asset":{"version":"2.0","generator":"g"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[{"name":"leaf","doubleSided":true,"emissiveFactor":[0,0,0],
"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}}],
"textures":[{"source":0,"sampler":0}],"images":[{"uri":"a.png"}],"samplers":[{"wrapS":33071,"wrapT":33071}],
"buffers":[{"uri":"a.bin","byteLength":92}],"bufferViews":[{"buffer":0,"byteLength":48},
{"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})");
}

ImportedScene read_text(const std::string& text, std::map<std::string, std::string> more = {}) {
  more.try_emplace("a.bin", quad());
  FilesInMemory files(std::move(more));
  return read_gltf(text, files);
}
ImportedScene read(const Json& json) { return read_text(json.dump()); }

std::vector<std::string> losses(const Json& json) { return texts_of(read(json).losses); }
Json with(Json json, const std::string& pointer, const std::string& value) {
  json[Json::json_pointer(pointer)] = Json::parse(value);
  return json;
}
std::vector<std::string> losses_with(const char* pointer, const char* value) {
  return losses(with(model(), pointer, value));
}
std::string refusal(const Json& json) {
  return refusal_by([&] { read(json); });
}
std::string refusal_with(const char* pointer, const char* value) { return refusal(with(model(), pointer, value)); }

/// Adds bytes to the model's buffer as a new view and accessor; returns the accessor's index.
size_t add_accessor(Json& json, std::string& buffer, const std::string& bytes, const std::string& accessor) {
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
  buffer += bytes;
  json["buffers"][0]["byteLength"] = buffer.size();
  json["accessors"].push_back(Json::parse(accessor));
  json["accessors"].back()["bufferView"] = json["bufferViews"].size() - 1;
  return json["accessors"].size() - 1;
}

/// A document that has an object of each kind of the record, and its buffer. Nodes: a mesh, one with instances, one
/// with a skin and weights of a morph target, a joint.
Json everything(std::string& buffer) {
  Json json = model();
  buffer = quad();
  const auto add = [&](const std::string& bytes, const char* accessor) {
    return add_accessor(json, buffer, bytes, accessor);
  };
  const char* const vec3 = R"({"componentType":5126,"count":4,"type":"VEC3"})";
  const char* const vec4 = R"({"componentType":5126,"count":4,"type":"VEC4"})";
  const std::string zeros(16, '\0');
  Json attributes = json["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = add(bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), vec3);
  attributes["TANGENT"] = add(bytes_of<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}), vec4);
  json["meshes"][0]["primitives"][0]["attributes"] = attributes;
  attributes["JOINTS_0"] = add(zeros, R"({"componentType":5121,"count":4,"type":"VEC4"})");
  attributes["WEIGHTS_0"] = add(bytes_of<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), vec4);
  const size_t inverse = add(bytes_of<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}),
                             R"({"componentType":5126,"count":1,"type":"MAT4"})");
  const size_t shifts = add(bytes_of<float>({1, 0, 0, 2, 0, 0}), R"({"componentType":5126,"count":2,"type":"VEC3"})");
  const size_t turns =
      add(bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0}), R"({"componentType":5126,"count":2,"type":"VEC4"})");
  add(bytes_of<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}), vec4);  // other tangents
  const size_t colors = add(bytes_of<float>({.5f, 1, 1, .5f, 1, 1, .5f, 1, 1, .5f, 1, 1}), vec3);
  json["skins"] = Json::parse(R"([{"joints":[3],"skeleton":3,"name":"s"}])");
  json["skins"][0]["inverseBindMatrices"] = inverse;
  json["nodes"] =
      Json::parse(R"([{"mesh":0,"name":"plain","children":[1,2,3],"translation":[1,0,0],"rotation":[0,0,1,0],
"scale":[2,2,2]},{"mesh":0,"matrix":[1,0,0,0,0,2,0,0,0,0,1,0,0,0,0,1]},{"mesh":1,"skin":0},{"camera":1}])");
  json["nodes"][0]["camera"] = 0;
  json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  json["cameras"] = Json::parse(R"([{"type":"perspective","name":"c","perspective":{"yfov":1,"aspectRatio":2,
"znear":1,"zfar":9}},{"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"znear":1,"zfar":9}}])");
  json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type":"spot","color":[1,0.5,0],
"intensity":3,"range":1,"name":"l","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}])");
  json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", shifts}, {"SCALE", shifts}, {"ROTATION", turns}, {"_ID", 9}};
  Json skinned = json["meshes"][0];
  skinned["primitives"][0]["attributes"] = attributes;
  skinned["primitives"][0]["material"] = 1;
  skinned["primitives"][0]["targets"] = Json::parse(R"([{"POSITION":0}])");
  skinned["primitives"].push_back(skinned["primitives"][0]);
  skinned["primitives"][1]["material"] = 2;
  skinned["primitives"].push_back(skinned["primitives"][0]);
  skinned["primitives"][2]["material"] = 3;
  json["meshes"].push_back(skinned);
  json["meshes"][1]["weights"] = Json::parse("[1]");
  json["meshes"][0]["name"] = "blade";
  json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
  json["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
  json["materials"][0]["emissiveTexture"] = Json::parse(R"({"index":1})");
  json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 2;
  json["materials"][0]["normalTexture"] = Json::parse(R"({"index":1,"scale":0.5})");
  json["materials"].push_back(
      Json::parse(R"({"name":"thin","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.5},"extensions":{
"KHR_materials_specular":{"specularFactor":0},"KHR_materials_diffuse_transmission":{
"diffuseTransmissionFactor":0.25,"diffuseTransmissionColorFactor":[1,0.5,0.25],"diffuseTransmissionTexture":{"index":1},
"diffuseTransmissionColorTexture":{"index":1,"extensions":{"KHR_texture_transform":{"offset":[0.1,0.2],"rotation":1,
"scale":[2,3],"texCoord":0}}}}}})"));
  json["materials"].push_back(
      Json::parse(R"({"name":"dew","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0},
"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.33},
"KHR_materials_volume":{"thicknessFactor":1}}})"));
  json["materials"].push_back(Json::parse(R"({"name":"wax","extensions":{"KHR_materials_pbrSpecularGlossiness":{
"diffuseFactor":[0.5,0.5,0.5,1],"diffuseTexture":{"index":1},"specularFactor":[0,0,0],"glossinessFactor":0}}})"));
  json["textures"].push_back(Json::parse(R"({"source":0,"extensions":{"EXT_texture_webp":{"source":1}}})"));
  json["images"].push_back(Json::parse(R"({"uri":"data:image/webp;base64,AAAA","mimeType":"image/webp","name":"w"})"));
  return json;
}

/// Where an object of each kind is, in `everything`.
const std::map<std::string_view, std::string> kPlaces{
    {"glTF", ""},
    {"asset", "/asset"},
    {"scene", "/scenes/0"},
    {"node", "/nodes/0"},
    {"mesh", "/meshes/0"},
    {"primitive", "/meshes/1/primitives/0"},
    {"attributes", "/meshes/1/primitives/0/attributes"},
    {"camera", "/cameras/0"},
    {"perspective", "/cameras/0/perspective"},
    {"orthographic", "/cameras/1/orthographic"},
    {"KHR_lights_punctual", "/nodes/0/extensions/KHR_lights_punctual"},
    {"light", "/extensions/KHR_lights_punctual/lights/0"},
    {"spot", "/extensions/KHR_lights_punctual/lights/0/spot"},
    {"skin", "/skins/0"},
    {"EXT_mesh_gpu_instancing", "/nodes/1/extensions/EXT_mesh_gpu_instancing"},
    {"instances", "/nodes/1/extensions/EXT_mesh_gpu_instancing/attributes"},
    {"material", "/materials/0"},
    {"pbrMetallicRoughness", "/materials/0/pbrMetallicRoughness"},
    {"KHR_materials_pbrSpecularGlossiness", "/materials/3/extensions/KHR_materials_pbrSpecularGlossiness"},
    {"KHR_materials_diffuse_transmission", "/materials/1/extensions/KHR_materials_diffuse_transmission"},
    {"KHR_materials_specular", "/materials/1/extensions/KHR_materials_specular"},
    {"KHR_materials_transmission", "/materials/2/extensions/KHR_materials_transmission"},
    {"KHR_materials_ior", "/materials/2/extensions/KHR_materials_ior"},
    {"KHR_materials_volume", "/materials/2/extensions/KHR_materials_volume"},
    {"KHR_materials_emissive_strength", "/materials/0/extensions/KHR_materials_emissive_strength"},
    {"textureInfo", "/materials/0/normalTexture"},
    {"KHR_texture_transform",
     "/materials/1/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture/extensions/"
     "KHR_texture_transform"},
    {"texture", "/textures/0"},
    {"EXT_texture_webp", "/textures/1/extensions/EXT_texture_webp"},
    {"sampler", "/samplers/0"},
    {"image", "/images/1"}};

/// Values for properties that are read, in place of those of `everything`, or of none there; others are removed. Where
/// the property is elsewhere, its place.
const std::map<std::string, std::vector<std::string>> kValues{
    {"asset.minVersion", {"\"2.1\""}},
    {"glTF.scene", {"1"}},
    {"glTF.extensionsRequired", {"[\"VENDOR_x\"]"}},
    {"glTF.extensionsUsed", {"[\"VENDOR_x\"]"}},
    {"camera.type", {"", "/cameras/1"}},
    {"camera.orthographic", {"", "/cameras/1"}},
    {"node.matrix", {"", "/nodes/1"}},
    {"node.skin", {"", "/nodes/2"}},
    {"node.weights", {"[0.5]", "/nodes/2"}},
    {"mesh.weights", {"[2]", "/meshes/1"}},
    {"primitive.mode", {"5"}},
    {"material.alphaMode", {"\"MASK\""}},
    {"material.alphaCutoff", {"0.25"}},
    {"pbrMetallicRoughness.baseColorFactor", {"[0.5,1,1,0.5]"}},
    {"pbrMetallicRoughness.roughnessFactor", {"0.5"}},
    {"pbrMetallicRoughness.metallicFactor", {"1"}},
    {"textureInfo.texCoord", {"1"}},
    {"KHR_texture_transform.texCoord", {"1"}},
    {"KHR_materials_diffuse_transmission.diffuseTransmission*", {"", "", "diffuseTransmissionFactor"}},
    {"texture.source", {"1"}},
    {"sampler.wrapS", {"10497"}},
    {"sampler.wrapT", {"10497"}},
    {"attributes.TEXCOORD_*", {"", "/meshes/0/primitives/0/attributes"}},
    {"attributes.NORMAL", {"", "/meshes/0/primitives/0/attributes"}},
    {"attributes.TANGENT", {"10", "/meshes/0/primitives/0/attributes"}},
    {"attributes.COLOR_0", {"", "/meshes/0/primitives/0/attributes"}},
    {"attributes.COLOR_*", {"", "", "COLOR_1"}},
    {"image.bufferView", {"0", "/images/0"}},
    {"image.uri", {"\"b.png\""}},
    {"image.mimeType", {"\"image/png\""}},
};

/// Each property of glTF 2.0 and of the extensions: what is read changes the scene, or the model is refused; what has
/// no effect changes nothing; what is lost is named, and not with its default.
TEST(GltfReader, EveryPropertyIsUsedOrNamed) {
  std::string buffer;
  const Json all = everything(buffer);
  const auto read_all = [&](const Json& json) { return read_text(json.dump(), {{"a.bin", buffer}}); };
  const ImportedScene scene = read_all(all);
  EXPECT_THAT(texts_of(scene.losses), ElementsAre("gloss of \"wax\""));
  std::vector<std::pair<GltfProperty, std::string>> properties;  // each name of the records
  for (const GltfProperty& p : gltf_properties()) {
    std::istringstream words{std::string(p.names)};
    for (std::string word; words >> word;) properties.emplace_back(p, word);
  }
  EXPECT_GT(properties.size(), 100u);
  for (const auto& [p, property] : properties) {
    const std::string name = std::string(p.object) + "." + property;
    SCOPED_TRACE(name);
    ASSERT_TRUE(kPlaces.contains(p.object));
    const auto row = kValues.find(name);
    const std::vector<std::string> values = row == kValues.end() ? std::vector<std::string>{""} : row->second;
    std::string key(values.size() > 2 ? values[2] : property);
    if (key.ends_with('*')) key.back() = '0';
    const std::string place = values.size() > 1 && !values[1].empty() ? values[1] : kPlaces.at(p.object);
    Json changed = all;
    Json& object = changed[Json::json_pointer(place)];
    if (p.use == GltfUse::lost || p.use == GltfUse::surface) {
      object[key] = Json::parse("[7]");
      EXPECT_THAT(texts_of(read_all(changed).losses), Contains(HasSubstr(std::string(p.says))));
      if (p.no_effect.empty()) continue;
      object[key] = Json::parse(p.no_effect);
      EXPECT_EQ(read_all(changed), scene);
    } else if (p.use == GltfUse::inert) {
      if (object.contains(key)) object.erase(key);
      EXPECT_EQ(read_all(changed), scene);
    } else {
      if (values[0].empty())
        ASSERT_EQ(object.erase(key), 1u);
      else
        object[key] = Json::parse(values[0]);
      ImportedScene other;
      const std::string refused = refusal_by([&] { other = read_all(changed); });
      EXPECT_TRUE(refused != "no refusal" || other != scene);
    }
  }
}

TEST(GltfReader, WhatIsReadIsNoLoss) { EXPECT_THAT(losses(model()), IsEmpty()); }

TEST(GltfReader, UnknownPropertiesAreNamed) {
  EXPECT_THAT(losses_with("/materials/0/emmisiveFactor", "[1,1,1]"),
              ElementsAre("unknown property material.emmisiveFactor of \"leaf\""));
  EXPECT_THAT(losses_with("/nodes/0/visible", "false"), ElementsAre("unknown property node.visible"));
  EXPECT_THAT(losses_with("/extras", R"({"anything":1})"), IsEmpty());
}

TEST(GltfReader, ExtensionsThatAreNotReadAreNamed) {
  for (const char* name : {"KHR_materials_sheen", "KHR_materials_clearcoat", "KHR_materials_iridescence",
                           "KHR_materials_anisotropy", "KHR_materials_dispersion", "VENDOR_x"}) {
    const std::string pointer = std::string("/materials/0/extensions/") + name;
    const auto expected = std::string("extension ") + name + " of \"leaf\"";
    EXPECT_THAT(losses_with(pointer.c_str(), "{}"), ElementsAre(expected));
    Json json = with(model(), pointer, "{}");
    json["extensionsUsed"] = {name};
    const std::vector<ImportedLoss> all = read(json).losses;
    ASSERT_EQ(all.size(), 1u);  // once, though it is in both places
    EXPECT_TRUE(all[0].is_surface);
  }
  EXPECT_THAT(losses_with("/extensionsUsed", R"(["EXT_lights_image_based"])"),
              ElementsAre("extension EXT_lights_image_based"));
  EXPECT_THAT(losses_with("/extensions/EXT_lights_ies", "{}"), ElementsAre("extension EXT_lights_ies"));
  EXPECT_THAT(losses_with("/meshes/0/primitives/0/extensions/KHR_materials_variants", "{}"),
              ElementsAre("extension KHR_materials_variants"));
}

/// Unlit surfaces have no gloss. A surface whose gloss is 0 has none to lose.
TEST(GltfReader, UnlitAndMattSurfaces) {
  Json json = with(model(), "/materials/0/extensions/KHR_materials_unlit", "{}");
  json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
  json["extensionsRequired"] = {"KHR_materials_unlit"};
  EXPECT_THAT(losses(json), ElementsAre("shading without light (KHR_materials_unlit) of \"leaf\""));
  json = with(model(), "/materials/0/extensions/KHR_materials_specular/specularFactor", "0");
  json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
  EXPECT_THAT(losses(json), IsEmpty());
}

TEST(GltfReader, LightsAndCamerasAreWhereTheirNodesAre) {
  std::string buffer;
  Json json = everything(buffer);
  const auto read_json = [&] { return read_text(json.dump(), {{"a.bin", buffer}}); };
  const ImportedScene scene = read_json();
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].type, ImportedLight::Type::spot);
  EXPECT_THAT(scene.lights[0].color, ElementsAre(3, 1.5, 0));
  EXPECT_EQ(std::pair(scene.lights[0].inner, scene.lights[0].outer), std::pair(0.1, 0.2));
  EXPECT_EQ(scene.lights[0].to_world[3], 1);
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_DOUBLE_EQ(scene.cameras[0].half[1], std::tan(0.5));
  EXPECT_DOUBLE_EQ(scene.cameras[0].half[0], 2 * std::tan(0.5));
  EXPECT_TRUE(scene.cameras[1].is_orthographic);
  EXPECT_THAT(scene.cameras[1].half, ElementsAre(2, 1));
  EXPECT_EQ(scene.cameras[1].to_world[3], 1);  // of its parent
  json["extensions"]["KHR_lights_punctual"]["lights"][0] = {{"type", "directional"}};
  EXPECT_EQ(read_json().lights[0].type, ImportedLight::Type::distant);
  EXPECT_THAT(read_json().lights[0].color, ElementsAre(1, 1, 1));
  json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "area";
  json["cameras"][0]["perspective"]["yfov"] = 0;
  json["nodes"][3]["camera"] = 7;
  EXPECT_THAT(texts_of(read_json().losses),
              UnorderedElementsAre(HasSubstr("gloss"), "light of an unknown type (KHR_lights_punctual)",
                                   "camera without a usable field of view", "camera that does not exist"));
}

/// Colours of vertices are factors: those that differ have no counterpart.
TEST(GltfReader, VertexColours) {
  const auto scene_of = [](const std::vector<float>& colors, const char* type, const char* mode = "OPAQUE") {
    Json json = model();
    std::string buffer = quad();
    const std::string accessor = std::string(R"({"componentType":5126,"count":4,"type":")") + type + "\"}";
    json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        add_accessor(json, buffer, bytes_of(colors), accessor);
    json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 1, 1, 1};
    json["materials"][0]["alphaMode"] = mode;
    return read_text(json.dump(), {{"a.bin", buffer}});
  };
  const auto material = [](const ImportedScene& scene) { return scene.materials[scene.meshes[0].material]; };
  using C = std::array<float, 3>;
  const std::vector<float> same{.5f, .25f, 1, .5f, .25f, 1, .5f, .25f, 1, .5f, .25f, 1};
  EXPECT_EQ(material(scene_of(same, "VEC3")).color, (C{0.25f, 0.25f, 1}));
  EXPECT_THAT(scene_of(same, "VEC3").losses, IsEmpty());
  const std::vector<float> white(12, 1.f);
  EXPECT_EQ(scene_of(white, "VEC3").materials.size(), 1u);
  std::vector<float> other = same;
  other[7] = 0;
  EXPECT_THAT(texts_of(scene_of(other, "VEC3").losses),
              ElementsAre("colours of vertices that differ (COLOR_0) of \"leaf\""));
  std::vector<float> alpha(16, 0.5f);
  EXPECT_EQ(material(scene_of(alpha, "VEC4", "BLEND")).opacity, 0.5f);
  EXPECT_EQ(material(scene_of(alpha, "VEC4")).opacity, 1);
  alpha[3] = 1;  // without effect on an opaque surface
  EXPECT_THAT(scene_of(alpha, "VEC4").losses, IsEmpty());
  EXPECT_EQ(scene_of(alpha, "VEC4", "BLEND").losses.size(), 1u);
}

TEST(GltfReader, SpecularColourAndMapAreNamed) {
  const char* const pointer = "/materials/0/extensions/KHR_materials_specular";
  EXPECT_THAT(losses_with(pointer, R"({"specularFactor":0,"specularColorFactor":[1,1,1]})"), IsEmpty());
  EXPECT_THAT(losses_with(pointer, R"({"specularColorFactor":[1,0,0],"specularTexture":{"index":0}})"),
              ElementsAre("colour of the gloss (specularColorFactor) of \"leaf\"", "specular map of \"leaf\""));
}

TEST(GltfReader, ImagesThatAreNotReadAreNamed) {
  Json json = model();
  json["textures"] = Json::parse(R"([{"extensions":{"KHR_texture_basisu":{"source":0}}}])");
  EXPECT_THAT(losses(json),
              ElementsAre("extension KHR_texture_basisu of \"leaf\"", "image of a texture without source of \"leaf\""));
  EXPECT_THAT(losses_with("/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "1"),
              ElementsAre("image of a primitive that has no TEXCOORD_1"));
  EXPECT_THAT(losses_with("/samplers/0/wrapT", "10497"), ElementsAre("wrap mode along v (wrapT) of \"leaf\""));
}

TEST(GltfReader, GlossAndMetalness) {
  const char* const roughness = "/materials/0/pbrMetallicRoughness/roughnessFactor";
  EXPECT_THAT(losses_with(roughness, "0.9"), ElementsAre("gloss of \"leaf\""));
  const char* const metalness = "/materials/0/pbrMetallicRoughness/metallicFactor";
  EXPECT_THAT(losses_with(metalness, "0.25"), ElementsAre("metalness between 0 and 1 (metallicFactor) of \"leaf\""));
  EXPECT_THAT(losses_with(metalness, "1"), ElementsAre("metalness of a roughness of 1 (metallicFactor) of \"leaf\""));
  Json json = model();
  json["materials"][0]["pbrMetallicRoughness"].erase("metallicFactor");
  EXPECT_THAT(losses(json), IsEmpty());
}

/// Objects that the scene does not have are not compared.
TEST(GltfReader, OnlyTheSceneCounts) {
  Json json = model();
  json["nodes"].push_back({{"extensions", {{"X_y", Json::object()}}}, {"mesh", 0}});
  json["materials"].push_back({{"occlusionTexture", {{"index", 0}}}});
  EXPECT_THAT(losses(json), IsEmpty());
  json["scenes"].push_back({{"nodes", {1}}});
  EXPECT_THAT(losses(json), ElementsAre("further scene"));
  json["scene"] = 1;
  EXPECT_THAT(losses(json), ElementsAre("further scene", "extension X_y"));
}

TEST(GltfReader, WhatIsRequiredAndNotReadIsRefused) {
  EXPECT_THAT(refusal_with("/extensionsRequired", R"(["KHR_draco_mesh_compression","KHR_texture_transform","X_y"])"),
              HasSubstr("not read: KHR_draco_mesh_compression, X_y (extensionsRequired)"));
  EXPECT_THAT(refusal_with("/asset/minVersion", R"("2.1")"), HasSubstr("glTF 2.1"));
  EXPECT_THAT(refusal_with("/asset/version", R"("1.0")"), HasSubstr("it is of glTF 1.0"));
}

/// Integers, as they are and normalized (3.6.2.2 of the specification); interleaved values.
TEST(GltfReader, AccessorsOfAllTypes) {
  const auto xs = [](const std::string& bytes, const std::string& type, size_t stride = 0) {
    Json json = model();
    std::string buffer = quad();
    const size_t at = add_accessor(json, buffer, bytes, R"({"componentType":)" + type + R"(,"count":4,"type":"VEC3"})");
    if (stride > 0) json["bufferViews"].back()["byteStride"] = stride;
    json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = at;
    std::vector<float> values;
    const ImportedScene scene = read_text(json.dump(), {{"a.bin", buffer}});
    for (const auto& p : scene.meshes[0].positions) values.push_back(p[0]);
    return values;
  };
  const auto three = [](auto a, auto b, auto c, auto d) {
    return bytes_of<decltype(a)>({a, 0, 0, b, 0, 0, c, 0, 0, d, 0, 0});
  };
  const auto near = [](const std::vector<float>& expected) { return Pointwise(::testing::FloatNear(1e-6f), expected); };
  EXPECT_THAT(xs(three(int8_t(-128), int8_t(127), int8_t(0), int8_t(7)), "5120"), near({-128, 127, 0, 7}));
  EXPECT_THAT(xs(three(int8_t(-128), int8_t(127), int8_t(0), int8_t(7)), "5120,\"normalized\":true"),
              near({-1, 1, 0, 7 / 127.f}));
  EXPECT_THAT(xs(three(uint8_t(255), uint8_t(51), uint8_t(0), uint8_t(1)), "5121,\"normalized\":true"),
              near({1, 0.2f, 0, 1 / 255.f}));
  EXPECT_THAT(xs(three(int16_t(-32768), int16_t(32767), int16_t(5), int16_t(0)), "5122"), near({-32768, 32767, 5, 0}));
  EXPECT_THAT(xs(three(int16_t(-32768), int16_t(32767), int16_t(0), int16_t(0)), "5122,\"normalized\":true"),
              near({-1, 1, 0, 0}));
  EXPECT_THAT(xs(three(uint16_t(65535), uint16_t(13107), uint16_t(0), uint16_t(0)), "5123,\"normalized\":true"),
              near({1, 0.2f, 0, 0}));
  EXPECT_THAT(xs(three(1.5f, -2.f, 3.f, 0.f), "5126"), near({1.5f, -2, 3, 0}));
  EXPECT_THAT(xs(bytes_of<float>({1, 0, 0, 9, 2, 0, 0, 9, 3, 0, 0, 9, 4, 0, 0, 9}), "5126", 16), near({1, 2, 3, 4}));
  EXPECT_THAT(xs(bytes_of<uint8_t>({1, 0, 0, 9, 2, 0, 0, 9, 3, 0, 0, 9, 4, 0, 0}), "5121", 4), near({1, 2, 3, 4}));
}

TEST(GltfReader, SparseAccessors) {
  Json json = model();
  std::string buffer = quad();
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 16}});
  buffer += bytes_of<uint32_t>({2}) + bytes_of<float>({7, 8, 9});
  json["buffers"][0]["byteLength"] = buffer.size();
  json["accessors"][0]["sparse"] = Json::parse(
      R"({"count":1,"indices":{"bufferView":3,"componentType":5125},"values":{"bufferView":3,"byteOffset":4}})");
  const auto positions = [&] { return read_text(json.dump(), {{"a.bin", buffer}}).meshes[0].positions; };
  EXPECT_EQ(positions()[2], (std::array<float, 3>{7, 8, 9}));
  EXPECT_EQ(positions()[1], (std::array<float, 3>{1, 0, 0}));
  json["accessors"][0].erase("bufferView");  // zeros, of which one is changed
  EXPECT_EQ(positions()[1], (std::array<float, 3>{0, 0, 0}));
  buffer[92] = 4;
  EXPECT_THAT(refusal_by(positions), HasSubstr("changes an element that it does not have"));
  json["accessors"][0]["sparse"] = Json::parse(R"({"count":9,"indices":{},"values":{}})");
  EXPECT_THAT(refusal_by(positions), HasSubstr("incomplete"));
}

TEST(GltfReader, InvalidGeometryIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal_with("/accessors/2/componentType", "5126"), HasSubstr("indices: it is of floats"));
  EXPECT_THAT(refusal_with("/accessors/0/componentType", "5124"), HasSubstr("unknown componentType"));
  EXPECT_THAT(refusal_with("/accessors/0/type", "\"VEC2\""), HasSubstr("it is VEC2, which is to be VEC3"));
  EXPECT_THAT(refusal_with("/meshes/0/primitives/0/mode", "7"), HasSubstr("there is no mode"));
  EXPECT_THAT(refusal_with("/buffers/0", R"({"byteLength":92})"), HasSubstr("its buffer has no uri"));
  EXPECT_THAT(refusal_with("/buffers/0/byteLength", "93"), HasSubstr("shorter than its byteLength"));
  EXPECT_THAT(refusal_with("/accessors/0/byteOffset", "4"),
              HasSubstr("meshes[0].primitives[0], POSITION: its accessor is longer than its bufferView"));
  EXPECT_THAT(refusal_with("/accessors/0/count", "5"), HasSubstr("longer than its bufferView"));
  EXPECT_THAT(refusal_with("/bufferViews/0/byteStride", "16"), HasSubstr("longer than its bufferView"));
  EXPECT_THAT(refusal_with("/bufferViews/0/byteOffset", "80"), HasSubstr("longer than its buffer"));
  EXPECT_THAT(refusal_with("/accessors/1/count", "3"), HasSubstr("not as many as positions"));
  EXPECT_THAT(refusal_with("/accessors/0/bufferView", "9"), HasSubstr("does not exist"));
  EXPECT_THAT(refusal_with("/nodes/0/children", "[0]"), HasSubstr("nodes[0] has two parents"));
  Json json = with(model(), "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", "{}");
  json["accessors"][0].erase("bufferView");
  EXPECT_THAT(refusal(json), HasSubstr("compressed by KHR_draco_mesh_compression"));
}

/// The joint is 10 along x and twice as large; the node's own transform has no effect (3.7.3.3).
TEST(GltfReader, JointsPlaceTheVerticesOfASkin) {
  std::string buffer;
  Json json = everything(buffer);
  json["scenes"][0]["nodes"] = Json::parse("[2,3]");
  json["nodes"] = Json::parse(R"([{},{},{"mesh":1,"skin":0,"scale":[100,100,100]},
{"translation":[10,0,0],"scale":[2,2,2]}])");
  const ImportedScene scene = read_text(json.dump(), {{"a.bin", buffer}});
  EXPECT_EQ(scene.nodes.back().parent, -1);
  EXPECT_EQ(scene.nodes.back().to_parent[0], 1);
  // The inverse bind matrix moves by (5, 6, 7) first; the morph target doubles.
  EXPECT_EQ(scene.meshes[scene.nodes.back().meshes[0]].positions[2], (std::array<float, 3>{24, 16, 14}));
}

TEST(GltfReader, InstancesAreNodes) {
  std::string buffer;
  Json json = everything(buffer);
  json["scenes"][0]["nodes"] = Json::parse("[1]");
  const ImportedScene scene = read_text(json.dump(), {{"a.bin", buffer}});
  ASSERT_EQ(scene.nodes.size(), 3u);
  EXPECT_THAT(scene.nodes[0].meshes, IsEmpty());
  EXPECT_EQ(scene.nodes[2].parent, 0);
  // Scale (2, 0, 0), half a turn about y, and 2 along x.
  EXPECT_THAT(scene.nodes[2].to_parent,
              Pointwise(::testing::DoubleEq(), {-2., 0., 0., 2., 0., 0., 0., 0., 0., 0., 0., 0.}));
}

/// u' and v' of the quadrilateral's corner (1, 0), v down, by the matrices of KHR_texture_transform's page.
TEST(GltfReader, TextureTransforms) {
  const auto uv = [](const char* transform) {
    const Json json =
        with(model(), "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform", transform);
    return read(json).meshes[0].uvs[2];
  };
  EXPECT_EQ(uv("{}"), (std::array<float, 2>{1, 1}));
  EXPECT_EQ(uv(R"({"offset":[0.25,0.5]})"), (std::array<float, 2>{1.25f, 0.5f}));
  EXPECT_EQ(uv(R"({"scale":[0.5,2]})"), (std::array<float, 2>{0.5f, 1}));
  const auto turned = uv(R"({"rotation":1.5707963267948966,"scale":[0.5,1]})");  // (0, -0.5), v down
  EXPECT_NEAR(turned[0], 0, 1e-6);
  EXPECT_NEAR(turned[1], 1.5, 1e-6);
}

/// The sign of the tangents decides on the side of a normal map; without tangents the texture coordinates do.
TEST(GltfReader, NormalMapsOfMirroredTextureCoordinates) {
  std::string buffer = quad();
  Json json = model();
  json["materials"][0]["normalTexture"] = Json::parse(R"({"index":0,"scale":0.5})");
  json["samplers"][0] = Json::object();
  const auto scales = [&](const std::vector<float>& uvs, const std::vector<float>& tangent) {
    Json other = json;
    std::string bytes = buffer;
    bytes.replace(48, 32, bytes_of<float>(uvs));
    std::vector<float> tangents;
    for (int i = 0; i < 4; ++i) tangents.insert(tangents.end(), tangent.begin(), tangent.end());
    if (!tangent.empty())
      other["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
          add_accessor(other, bytes, bytes_of<float>(tangents), R"({"componentType":5126,"count":4,"type":"VEC4"})");
    const ImportedScene scene = read_text(other.dump(), {{"a.bin", bytes}});
    for (const ImportedMesh& mesh : scene.meshes)
      EXPECT_EQ(mesh.positions.size(), mesh.triangles.size() + 2);  // those of no triangle are removed
    std::vector<float> all;
    for (const ImportedMesh& mesh : scene.meshes) all.push_back(scene.materials[mesh.material].normal_scale[1]);
    EXPECT_EQ(scene.losses.size(), tangent.empty() || (uvs[2] > uvs[0]) == (tangent[0] > 0) ? 0u : 1u);
    return all;
  };
  const std::vector<float> straight{0, 1, 1, 1, 1, 0, 0, 0}, mirrored{1, 1, 0, 1, 0, 0, 1, 0};
  EXPECT_THAT(scales(straight, {}), ElementsAre(0.5f));
  EXPECT_THAT(scales(mirrored, {}), ElementsAre(-0.5f));
  EXPECT_THAT(scales({0, 1, 1, 1, 1, 0, 2, 0}, {}), ElementsAre(0.5f, -0.5f));  // one triangle of two
  EXPECT_THAT(scales(straight, {1, 0, 0, 1}), ElementsAre(0.5f));
  EXPECT_THAT(scales(straight, {1, 0, 0, -1}), ElementsAre(-0.5f));
  EXPECT_THAT(scales(mirrored, {-1, 0, 0, -1}), ElementsAre(-0.5f));
  EXPECT_THAT(scales(straight, {-1, 0, 0, 1}), ElementsAre(0.5f));  // named
}

TEST(GltfReader, StripsAndFans) {
  const auto triangles = [](const char* mode) {
    return read(with(model(), "/meshes/0/primitives/0/mode", mode)).meshes[0].triangles;
  };
  using T = std::array<uint32_t, 3>;
  EXPECT_THAT(triangles("4"), ElementsAre(T{0, 1, 2}, T{0, 2, 3}));
  EXPECT_THAT(triangles("5"), ElementsAre(T{0, 1, 2}, T{1, 0, 2}, T{2, 0, 2}, T{0, 3, 2}));
  EXPECT_THAT(triangles("6"), ElementsAre(T{0, 1, 2}, T{0, 2, 0}, T{0, 0, 2}, T{0, 2, 3}));
}

TEST(GltfReader, DamagedJsonIsRefusedWithItsPlace) {
  const auto refusal = [](const std::string& text) { return refusal_by([&] { read_text(text); }); };
  EXPECT_THAT(refusal("{\"a\":\n 1,}"), HasSubstr("its JSON is damaged: parse error at line 2, column 4"));
  EXPECT_THAT(refusal("{\"a\":1,\"a\":2}"), HasSubstr("has \"a\" twice"));
  EXPECT_THAT(refusal(std::string(300, '[')), HasSubstr("more than 200 levels deep"));
  EXPECT_THAT(refusal("[]"), HasSubstr("its JSON is no object"));
  EXPECT_THAT(refusal(std::string("glTF\2\0\0\0\0\0\0\0\x7f\0\0\0JSON{}", 22)), HasSubstr("cut short"));
  std::string text = model().dump();
  text.replace(text.find("leaf"), 4, "bl\xe4t");  // Latin-1
  EXPECT_THAT(read_text(text).losses, IsEmpty());
}

}  // namespace
}  // namespace frond
