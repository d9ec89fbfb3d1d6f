#include "imports/gltf_check.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "imports/gltf_properties.h"

namespace frond {
namespace {

using Json = nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A quadrilateral with texture coordinates and a material "leaf" with an image: all of it is read.
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

std::vector<std::string> losses(const Json& json) {
  std::vector<std::string> texts;
  for (const ImportedLoss& loss : check_gltf(json.dump())) texts.push_back(text_of(loss));
  return texts;
}

/// Losses of the model with a value at a JSON pointer.
std::vector<std::string> losses_with(const char* pointer, const char* value) {
  Json json = model();
  json[Json::json_pointer(pointer)] = Json::parse(value);
  return losses(json);
}

std::string refusal(const std::string& text) {
  try {
    check_gltf(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no refusal";
}

std::string refusal_with(const char* pointer, const char* value) {
  Json json = model();
  json[Json::json_pointer(pointer)] = Json::parse(value);
  return refusal(json.dump());
}

TEST(GltfCheck, WhatIsReadIsNoLoss) { EXPECT_THAT(losses(model()), IsEmpty()); }

/// Every property of the record that is lost is named, and that with its default is not.
TEST(GltfCheck, EveryLostPropertyIsNamed) {
  const std::map<std::string_view, std::string> place{
      {"glTF", ""},
      {"node", "/nodes/0"},
      {"primitive", "/meshes/0/primitives/0"},
      {"attributes", "/meshes/0/primitives/0/attributes"},
      {"material", "/materials/0"},
      {"pbrMetallicRoughness", "/materials/0/pbrMetallicRoughness"},
      {"textureInfo", "/materials/0/pbrMetallicRoughness/baseColorTexture"},
      {"sampler", "/samplers/0"}};
  size_t tried = 0;
  for (const GltfProperty& p : gltf_properties()) {
    if ((p.use != GltfUse::lost && p.use != GltfUse::surface) || !place.contains(p.object)) continue;
    std::string key(p.name);
    if (key.ends_with('*')) key.back() = '0';
    const std::string pointer = place.at(p.object) + "/" + key;
    EXPECT_THAT(losses_with(pointer.c_str(), "[7]"), Contains(HasSubstr(std::string(p.says)))) << pointer;
    if (!p.no_effect.empty()) {
      EXPECT_THAT(losses_with(pointer.c_str(), std::string(p.no_effect).c_str()), IsEmpty()) << pointer;
    }
    ++tried;
  }
  EXPECT_GE(tried, 9u);
}

TEST(GltfCheck, UnknownPropertiesAreNamed) {
  EXPECT_THAT(losses_with("/materials/0/emmisiveFactor", "[1,1,1]"),
              ElementsAre("unknown property material.emmisiveFactor of \"leaf\""));
  EXPECT_THAT(losses_with("/nodes/0/visible", "false"), ElementsAre("unknown property node.visible"));
  EXPECT_THAT(losses_with("/extras", R"({"anything":1})"), IsEmpty());
}

TEST(GltfCheck, ExtensionsThatAreNotReadAreNamed) {
  for (const char* name : {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior",
                           "KHR_materials_unlit", "KHR_materials_sheen", "KHR_materials_specular",
                           "KHR_materials_clearcoat", "KHR_materials_iridescence", "KHR_materials_anisotropy",
                           "KHR_materials_emissive_strength", "KHR_materials_diffuse_transmission", "VENDOR_x"}) {
    const std::string pointer = std::string("/materials/0/extensions/") + name;
    const auto expected = std::string("extension ") + name + " of \"leaf\"";
    EXPECT_THAT(losses_with(pointer.c_str(), "{}"), ElementsAre(expected));
    const std::vector<ImportedLoss> all = check_gltf([&] {
      Json json = model();
      json[Json::json_pointer(pointer)] = Json::object();
      json["extensionsUsed"] = {name};
      return json.dump();
    }());
    ASSERT_EQ(all.size(), 1u);  // once, though it is in both places
    EXPECT_TRUE(all[0].is_surface);
  }
  EXPECT_THAT(losses_with("/extensionsUsed", R"(["EXT_lights_image_based"])"),
              ElementsAre("extension EXT_lights_image_based"));
  EXPECT_THAT(losses_with("/extensions/EXT_lights_ies", "{}"), ElementsAre("extension EXT_lights_ies"));
  EXPECT_THAT(losses_with("/meshes/0/primitives/0/extensions/KHR_materials_variants", "{}"),
              ElementsAre("extension KHR_materials_variants"));
  EXPECT_THAT(losses_with("/nodes/0/extensions/KHR_lights_punctual", R"({"light":0})"),
              ElementsAre("light (KHR_lights_punctual)"));
}

TEST(GltfCheck, OfTextureTransformsAllButAnotherSetIsRead) {
  Json json = model();
  json["extensionsUsed"] = {"KHR_texture_transform"};
  json["extensionsRequired"] = json["extensionsUsed"];
  Json& transform =
      json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"];
  transform = Json::parse(R"({"offset":[0.1,0.2],"rotation":1,"scale":[2,3],"texCoord":0})");
  EXPECT_THAT(losses(json), IsEmpty());
  transform["texCoord"] = 1;
  EXPECT_THAT(losses(json), ElementsAre("texCoord of KHR_texture_transform of \"leaf\""));
  json.erase("extensionsRequired");
  json.erase("extensionsUsed");  // the library reads only what is declared
  transform.erase("texCoord");
  EXPECT_THAT(losses(json), ElementsAre("extension KHR_texture_transform of \"leaf\""));
}

TEST(GltfCheck, ImagesThatAreNotReadAreNamed) {
  Json json = model();
  json["textures"] = Json::parse(R"([{"extensions":{"EXT_texture_webp":{"source":0}}}])");
  EXPECT_THAT(losses(json),
              ElementsAre("extension EXT_texture_webp of \"leaf\"", "image of a texture without source of \"leaf\""));
  EXPECT_THAT(losses_with("/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "1"),
              ElementsAre("image of a primitive that has no TEXCOORD_1"));
  EXPECT_THAT(losses_with("/samplers/0/wrapT", "10497"), ElementsAre("wrap mode along v (wrapT) of \"leaf\""));
}

TEST(GltfCheck, NormalMaps) {
  Json json = model();
  json["materials"][0]["normalTexture"] = Json::parse(R"({"index":0,"scale":0.3})");
  json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 0;
  EXPECT_THAT(losses(json),
              ElementsAre("scale of the normal map (normalTexture.scale) of \"leaf\"",
                          "wrap mode of the normal map of \"leaf\"", "TANGENT of a primitive with a normal map"));
  json["materials"][0].erase("normalTexture");
  EXPECT_THAT(losses(json), IsEmpty());
}

TEST(GltfCheck, GlossAndMetalness) {
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
TEST(GltfCheck, OnlyTheSceneCounts) {
  Json json = model();
  json["nodes"].push_back({{"camera", 0}, {"skin", 0}, {"mesh", 0}});
  json["materials"].push_back({{"emissiveFactor", {1, 1, 1}}});
  EXPECT_THAT(losses(json), IsEmpty());
  json["scenes"].push_back({{"nodes", {1}}});
  EXPECT_THAT(losses(json), ElementsAre("further scene"));
  json["scene"] = 1;
  EXPECT_THAT(refusal(json.dump()), HasSubstr("nodes[1] has a skin"));
}

TEST(GltfCheck, WhatIsRequiredAndNotReadIsRefused) {
  EXPECT_THAT(refusal_with("/extensionsRequired", R"(["KHR_draco_mesh_compression","KHR_texture_transform","X_y"])"),
              HasSubstr("not read: KHR_draco_mesh_compression, X_y (extensionsRequired)"));
  EXPECT_THAT(refusal_with("/asset/minVersion", R"("2.1")"), HasSubstr("glTF 2.1"));
}

TEST(GltfCheck, GeometryThatWouldBeMisreadIsRefused) {
  EXPECT_THAT(refusal_with("/accessors/1/componentType", "5123"),
              HasSubstr("meshes[0].primitives[0], TEXCOORD_0: it is VEC2 of unsigned shorts, read is VEC2 of floats"));
  EXPECT_THAT(refusal_with("/accessors/0/componentType", "5122"), HasSubstr("POSITION: it is VEC3 of shorts"));
  EXPECT_THAT(refusal_with("/accessors/2/componentType", "5126"), HasSubstr("indices: it is SCALAR of floats"));
  EXPECT_THAT(refusal_with("/nodes/0/extensions/EXT_mesh_gpu_instancing", "{}"), HasSubstr("nodes[0] has instances"));
  EXPECT_THAT(refusal_with("/nodes/0/weights", "[0,0.5]"), HasSubstr("morph targets with weights"));
  EXPECT_THAT(refusal_with("/meshes/0/weights", "[1]"), HasSubstr("morph targets with weights"));
  EXPECT_THAT(refusal_with("/meshes/0/primitives/0/mode", "7"), HasSubstr("there is no mode"));
  EXPECT_THAT(refusal_with("/buffers/0", R"({"byteLength":92,"uri":"a.bin","extensions":
{"EXT_meshopt_compression":{"fallback":true}}})"),
              HasSubstr("compressed by EXT_meshopt_compression"));
  EXPECT_THAT(refusal_with("/buffers/0", R"({"byteLength":92})"), HasSubstr("its buffer has no uri"));
  Json json = model();
  json["accessors"][0].erase("bufferView");
  EXPECT_THAT(refusal(json.dump()), HasSubstr("its accessor has no bufferView"));
}

/// The library does not check these, and would read other bytes.
TEST(GltfCheck, AccessorsEndInsideTheirBuffers) {
  EXPECT_THAT(refusal_with("/accessors/0/byteOffset", "4"), HasSubstr("longer than its bufferView"));
  EXPECT_THAT(refusal_with("/accessors/0/count", "5"), HasSubstr("longer than its bufferView"));
  EXPECT_THAT(refusal_with("/bufferViews/0/byteStride", "16"), HasSubstr("longer than its bufferView"));
  EXPECT_THAT(refusal_with("/bufferViews/0/byteOffset", "80"), HasSubstr("longer than its buffer"));
  EXPECT_THAT(refusal_with("/accessors/1/count", "3"), HasSubstr("not as many as positions"));
  EXPECT_THAT(refusal_with("/accessors/0/bufferView", "9"), HasSubstr("does not exist"));
}

TEST(GltfCheck, SparseAccessorsAreReadUnlessTheyAreInterleaved) {
  const char* const sparse = R"({"count":1,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":0}})";
  EXPECT_THAT(losses_with("/accessors/0/sparse", sparse), IsEmpty());
  EXPECT_THAT(refusal_with("/accessors/0/sparse", R"({"count":9,"indices":{},"values":{}})"), HasSubstr("incomplete"));
  EXPECT_THAT(refusal_with("/accessors/0/sparse",
                           R"({"count":4,"indices":{"bufferView":2,"componentType":5125},"values":{"bufferView":0}})"),
              HasSubstr("longer than its bufferView"));
}

TEST(GltfCheck, DamagedJsonIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal("{\"a\":\n 1,}"), HasSubstr("its JSON is damaged: parse error at line 2, column 4"));
  EXPECT_THAT(refusal("{\"a\":1,\"a\":2}"), HasSubstr("has \"a\" twice"));
  EXPECT_THAT(refusal(std::string(300, '[')), HasSubstr("more than 200 levels deep"));
  EXPECT_THAT(refusal("[]"), HasSubstr("its JSON is no object"));
  EXPECT_THAT(refusal(std::string("glTF\2\0\0\0\0\0\0\0\x7f\0\0\0JSON{}", 22)), HasSubstr("cut short"));
  Json json = model();
  std::string text = json.dump();
  text.replace(text.find("leaf"), 4, "bl\xe4t");  // Latin-1
  EXPECT_THAT(check_gltf(text), IsEmpty());
}

}  // namespace
}  // namespace frond
