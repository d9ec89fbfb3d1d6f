#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "image/image_codec.h"
#include "image/image_file.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[v >> (18 - 6 * k) & 63];
  }
  return out;
}

/// Content of a buffer with one quadrilateral, 1 x 1, in the xy plane: positions, texture coordinates, indices.
std::string quad_buffer() {
  const float p[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, uv[] = {0, 1, 1, 1, 1, 0, 0, 0};
  const uint16_t indices[] = {0, 1, 2, 0, 2, 3};
  std::string bytes(sizeof p + sizeof uv + sizeof indices, '\0');
  std::memcpy(bytes.data(), p, sizeof p);
  std::memcpy(bytes.data() + sizeof p, uv, sizeof uv);
  std::memcpy(bytes.data() + sizeof p + sizeof uv, indices, sizeof indices);
  return bytes;
}

/// glTF with the quadrilateral as mesh 0. `buffer` is its JSON without the length, `views` are further buffer views.
std::string gltf(const std::string& nodes, const std::string& materials, const std::string& buffer,
                 const std::string& more = "", size_t length = 92, const std::string& views = "") {
  return fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],
"meshes":[{{"name":"blade","primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
"materials":[{}],"buffers":[{{{}"byteLength":{}}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},
{{"buffer":0,"byteOffset":80,"byteLength":12}}{}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
{{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}},
{{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}}]{}}})",
                     nodes, materials, buffer, length, views, more);
}

std::string embedded() { return "\"uri\":\"data:application/octet-stream;base64," + base64(quad_buffer()) + "\","; }

/// A binary glTF file of this JSON and buffer.
std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto word = [](size_t v) {
    const auto number = uint32_t(v);
    return std::string(reinterpret_cast<const char*>(&number), 4);
  };
  return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" + json +
         word(binary.size()) + std::string("BIN\0", 4) + binary;
}

/// PNG with alpha: opaque left half, then transparent.
std::string png_with_alpha() {
  Image image(8, 8, {"R", "G", "B", "A"});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) image.at(x, y, 1) = 0.7f, image.at(x, y, 3) = x < 4 ? 1.f : 0.3f;
  const auto bytes = image_codec().encode("leaf.png", image, {});
  return {bytes.begin(), bytes.end()};
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ImportCommand : public CommandTest {
 protected:
  /// Imports to scene.pbrt; the result passes the check, and its image has a value that is not the sky's.
  Outcome imported(const std::string& model, const Words& options = {}) {
    const Outcome o = frond_command({"import", path(model), "-o", path("scene.pbrt")}, options);
    EXPECT_EQ(o.code, 0) << o.err;
    if (o.code != 0) return o;
    const Outcome checked = frond_command({"check", path("scene.pbrt"), "--strict"});
    EXPECT_EQ(checked.code, 0) << checked.err << checked.out;
    const Outcome rendered = frond_command({"render", path("scene.pbrt"), "-o", path("scene.exr"), "--pixels",
                                            "300,500,300,500", "--spp", "1", "-q", "--no-cache"});
    EXPECT_EQ(rendered.code, 0) << rendered.err;
    const Image image = read_image(path("scene.exr"), {}).image;
    const size_t green = *image.channel("G");
    std::set<float> values;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) values.insert(image.at(x, y, green));
    EXPECT_GT(*values.rbegin(), 0);
    EXPECT_TRUE(std::isfinite(*values.rbegin()));
    EXPECT_GT(values.size(), 10u);  // not the sky alone
    return o;
  }
  /// Returns the message of an import that has to fail, and to write nothing.
  std::string refusal(const std::string& model, const Words& options = {}) {
    const auto files = [this] {
      std::set<fs::path> all;
      for (const auto& entry : fs::recursive_directory_iterator(path(""))) all.insert(entry.path());
      return all;
    };
    const auto before = files();
    const Outcome o = frond_command({"import", path(model), "-o", path("refused.pbrt")}, options);
    EXPECT_EQ(o.code, 1) << o.err << o.out;
    EXPECT_EQ(files(), before);
    return o.err;
  }
  std::string plant() const { return text_of(path("scene-plant.pbrt")); }
};

constexpr const char* kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

TEST_F(ImportCommand, ObjWithTwoMaterialsAndAnOpacityMap) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl",
                "newmtl Leaf 1\nKd 0 0 0\nmap_Kd C:\\art\\leaf.png\nmap_d leaf.png\nnewmtl stem\nKd .3 .2 .1\nd 0.5\n");
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad +
                                 "v 0 0 1\nv 1 0 1\nv 1 1 1\nusemtl Leaf 1\nf 1/1 2/2 3/3 4/4\nusemtl stem\nf 5 6 7\n");
  const Outcome o = imported("plant.obj");
  EXPECT_THAT(o.err, HasSubstr("its unit is taken as m (--unit) and y as up (--up)"));
  EXPECT_THAT(o.out, AllOf(HasSubstr("Leaf 1: diffuse, 2 triangles"), HasSubstr("stem: diffuse, 1 triangle")));
  EXPECT_THAT(plant(), AllOf(HasSubstr("\"texture alpha\" \"Leaf 1-alpha\""), HasSubstr("\"float alpha\" 0.5"),
                             HasSubstr("\"rgb reflectance\" [ 0.3 0.2 0.1 ]"),
                             HasSubstr("\"string filename\" \"scene-files/leaf.png\"")));
  EXPECT_EQ(text_of(path("scene-files/leaf.png")), png_with_alpha());  // as it is
  const Image alpha = read_image(path("scene-files/Leaf_1-alpha.png"), {}).image;
  EXPECT_EQ(alpha.channels.size(), 1u);
  EXPECT_EQ(alpha.at(0, 0, 0), 1);
  EXPECT_NEAR(alpha.at(7, 0, 0), 0.3f, 0.01f);
}

TEST_F(ImportCommand, LeavesAreMaterialsByName) {
  folder_.write("plant.obj", std::string(kQuad) + "usemtl Leaf.001\nf 1/1 2/2 3/3 4/4\nusemtl bark\nf 1 2 4\n");
  imported("plant.obj", {"--leaf", "leaf*=leaf_lambert,specimen=maize,thickness=2e-4"});
  EXPECT_THAT(plant(),
              AllOf(HasSubstr("MakeNamedMaterial \"Leaf.001\" \"string type\" \"leaf_lambert\""),
                    HasSubstr("\"string specimen\" [ \"maize\" ]"), HasSubstr("\"float thickness\" [ 0.0002 ]"),
                    HasSubstr("MakeNamedMaterial \"bark\" \"string type\" \"diffuse\"")));
  EXPECT_THAT(refusal("plant.obj", {"--leaf", "laef*=leaf"}),
              HasSubstr("--leaf laef*=leaf: the model has no such material; its materials are \"Leaf.001\", \"bark\""));
  EXPECT_THAT(refusal("plant.obj", {"--leaf", "leaf*=laef"}), HasSubstr("unknown material \"laef\""));
  EXPECT_THAT(refusal("plant.obj", {"--leaf", "leaf*=leaf,thicknes=1"}), HasSubstr("did you mean \"thickness\""));
  EXPECT_THAT(refusal("plant.obj", {"--leaf", "leaf*"}), HasSubstr("--leaf takes NAME=PLUGIN"));
}

/// A plane leaf with base colour, alpha and normal map.
TEST_F(ImportCommand, WhatALeafMaterialReplacesIsNamed) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl leaf\nmap_Kd leaf.png\nmap_d leaf.png\nnorm leaf.png\nKe 1 1 1\n");
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  const Outcome o = imported("plant.obj", {"--leaf", "leaf=leaf_lambert", "--strict"});
  EXPECT_THAT(o.err, AllOf(HasSubstr("without effect under --leaf"), HasSubstr("emission of \"leaf\""),
                           HasSubstr("colour image leaf.png of \"leaf\""), HasSubstr("alpha and normal maps are kept"),
                           HasSubstr("chlorophylla=@4:1 in --leaf")));
  EXPECT_THAT(plant(), AllOf(HasSubstr("\"texture alpha\" \"leaf-alpha\""), HasSubstr("\"string normalmap\"")));
}

/// Green is 0.7 in sRGB, 0.4479 in linear values; the mean of the channels is a third of it.
TEST_F(ImportCommand, ALeafFollowsTheBrightnessOfItsImage) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl leaf\nmap_Kd leaf.png\n");
  folder_.write("plant.obj",
                std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\nusemtl bare\nf 1 2 3\n");
  const Outcome o = imported("plant.obj", {"--leaf", "leaf=leaf_lambert,specimen=maize,chlorophylla=@4:1"});
  EXPECT_THAT(o.err, Not(HasSubstr("without effect")));
  EXPECT_THAT(plant(),
              AllOf(HasSubstr("\"mix\" \"float tex1\" 4 \"float tex2\" 1 \"texture amount\" \"leaf-brightness\""),
                    HasSubstr("\"texture chlorophylla\" \"leaf-chlorophylla\"")));
  EXPECT_NEAR(read_image(path("scene-files/leaf-brightness.png"), {}).image.at(0, 0, 0), 0.4479f / 3, 0.003f);
  const auto refused = [this](const std::string& leaf) { return refusal("plant.obj", {"--leaf", leaf}); };
  EXPECT_THAT(refused("bare=leaf_lambert,chlorophylla=@4:1"), HasSubstr("\"bare\" has no image of its colour"));
  EXPECT_THAT(refused("leaf=leaf_lambert,chlorophylla=@4"), HasSubstr("chlorophylla=@BLACK:WHITE"));
  EXPECT_THAT(refused("leaf=leaf_lambert,specimen=@4:1"),
              HasSubstr("\"specimen\" of \"leaf_lambert\" takes no texture"));
  EXPECT_THAT(refused("leaf=leaf_lambert,chlorophylla=@-4:1"), HasSubstr("-4 was given"));
}

TEST_F(ImportCommand, WithoutASceneTheContentIsListed) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl leaf\nmap_Kd leaf.png\nmap_d leaf.png\nnewmtl stem\n");
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad +
                                 "v 0 0 250\nusemtl leaf\nf 1/1 2/2 3/3 4/4\nusemtl stem\nf 1 2 5\n");
  const auto files = [this] {
    return std::distance(fs::recursive_directory_iterator(path("")), fs::recursive_directory_iterator());
  };
  const auto before = files();
  const Outcome o = frond_command({"import", path("plant.obj"), "--up", "z"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(files(), before);
  EXPECT_THAT(o.out, AllOf(HasSubstr("leaf: diffuse, 2 triangles, colour from leaf.png, alpha from leaf.png\n"),
                           HasSubstr("stem: diffuse, 1 triangle\n"), HasSubstr("z: 0 to 250 m\n"),
                           HasSubstr("nothing is written")));
  EXPECT_THAT(o.err,
              HasSubstr("the model is 250 m high, which no plant is: --unit cm makes it 2.5 m, mm makes it 0.25 m"));
  EXPECT_THAT(frond_command({"import", path("plant.obj"), "--up", "z", "--unit", "cm"}).err,
              Not(HasSubstr("no plant")));
  folder_.write("two.gltf", gltf(R"({"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[2,0,0]})",
                                 "{\"name\":\"leaf\"}", embedded()));
  EXPECT_THAT(frond_command({"import", path("two.gltf")}).out, HasSubstr("object blade: 2 triangles, 2 instances\n"));
  EXPECT_EQ(frond_command({"import", path("missing.obj")}).code, 1);
}

TEST_F(ImportCommand, UnitAndAxis) {
  folder_.write("plant.obj", "v 0 0 0\nv 0 0 250\nv 50 10 0\nf 1 2 3\n");
  const Outcome o = imported("plant.obj", {"--up", "z", "--unit", "cm"});
  EXPECT_THAT(o.out, HasSubstr("0.5 x 0.1 x 2.5 m"));
  EXPECT_THAT(o.err, Not(HasSubstr("does not state")));
  EXPECT_THAT(imported("plant.obj", {"--scale", "0.1"}).out, HasSubstr("5 x 25 x 1 m"));
  EXPECT_EQ(frond_command({"import", path("plant.obj"), "-o", path("y.pbrt"), "--scale", "1", "--unit", "m"}).code, 1);
}

/// Root turned by 90 degrees about y, and shifted; its two children have the quadrilateral, one of them mirrored.
TEST_F(ImportCommand, GltfNodesAreInstances) {
  folder_.write("plant.gltf",
                gltf(R"({"name":"root","children":[1,2],"translation":[10,20,30],"rotation":[0,0.7071067811865476,0,
0.7071067811865476]},{"mesh":0,"scale":[2,2,2]},{"mesh":0,"translation":[0,0,5],"scale":[-1,1,1]})",
                     R"({"name":"leaf","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.4,0.1,1],"metallicFactor":0}})",
                     embedded()));
  const Outcome o = imported("plant.gltf");
  EXPECT_THAT(o.out, HasSubstr("2 instances of 1 object"));
  EXPECT_THAT(o.err, Not(HasSubstr("does not state")));
  // Columns of the first map: x = (2,0,0) turns to -z of glTF, which is +y of the scene; y is up.
  EXPECT_THAT(plant(), AllOf(HasSubstr("ObjectBegin \"blade\""), HasSubstr("ObjectInstance \"blade\"")));
  const std::string text = plant();
  const size_t at = text.find("ConcatTransform [ ");
  std::istringstream numbers(text.substr(at + 18));
  const double expected[] = {0, 2, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 10, -30, 20, 1};
  for (const double e : expected) {
    double v = 0;
    numbers >> v;
    EXPECT_NEAR(v, e, 1e-5);
  }
}

/// Two leaves of one material, each an object, and its light by name, by part and, with a stem, by material.
TEST_F(ImportCommand, ObjectsAreKeptByNameForTheirLight) {
  folder_.write("two.obj",
                "mtllib two.mtl\no lower\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl green\nf 1 2 3 4\n"
                "o upper\nv 0 0 1\nv 0.5 0 1\nv 0.5 1 1\nv 0 1 1\nf 5 6 7 8\n");
  folder_.write("two.mtl", "newmtl green\nKd 0.1 0.5 0.1\n");
  const auto rows = [this](const Words& how, const std::string& by) {
    imported("two.obj", joined({"--up", "z", "--unit", "m", "--leaf", "green=leaf_lambert,specimen=soybean"}, how));
    const Outcome o = frond_command({"flux", path("scene.pbrt"), "--bands", "par", "--by", by, "--irradiance",
                                     "solar-am1.5-global", "--paths", "20000", "--csv", path("organs.csv"), "-q",
                                     "--no-cache", "--ply", path("organs.ply")});
    EXPECT_EQ(o.code, 0) << o.err;
    std::ifstream csv(path("organs.csv"));
    return std::string(std::istreambuf_iterator<char>(csv), {});
  };
  EXPECT_THAT(rows({"--objects"}, "instance"),
              ::testing::ContainsRegex("^instance,name,material_name,area,x,y,z,par_w_m2,.*\n"
                                       "1,lower,green,1,0.5,0.5,0,[1-9].*\n2,upper,green,0.5,0.25,0.5,1,[1-9]"));
  EXPECT_THAT(
      rows({}, "part"),
      ::testing::ContainsRegex("^part,name,.*\n1,green,green,0,1,0.5,0.5,0,[1-9].*\n2,green,green,0,0.5,0.25,0.5,1,"));
  EXPECT_THAT(rows({}, "mesh"), ::testing::ContainsRegex("^mesh,.*\n1,green,green,0,1.5,"));
  EXPECT_TRUE(fs::exists(path("organs.ply")));
}

TEST_F(ImportCommand, ManyInstancesAreATable) {
  std::string children, nodes;
  for (int i = 1; i <= 1500; ++i) {
    children += fmt::format("{}{}", i > 1 ? "," : "", i);
    nodes += fmt::format(",{{\"mesh\":0,\"translation\":[{},{},0]}}", i % 40 * 2, i / 40 * 2);
  }
  folder_.write("field.gltf", gltf("{\"children\":[" + children + "]}" + nodes, "{\"name\":\"leaf\"}", embedded()));
  EXPECT_THAT(imported("field.gltf").out, HasSubstr("1500 instances of 1 object"));
  EXPECT_THAT(plant(), AllOf(HasSubstr("Shape \"instances\" \"string object\" \"blade\" \"string filename\" "
                                       "\"scene-files/blade.npy\""),
                             Not(HasSubstr("ObjectInstance"))));
  EXPECT_GT(fs::file_size(path("scene-files/blade.npy")), 1500u * 48);
}

/// The image is part of the file; alpha below the cutoff is cut, and the colour factor tints it.
TEST_F(ImportCommand, GlbWithAnImageInsideAndACutoff) {
  const std::string png = png_with_alpha();
  const std::string image = fmt::format(R"(,"images":[{{"bufferView":3,"mimeType":"image/png","name":"blade"}}],
"textures":[{{"source":0}}])");
  folder_.write("plant.glb",
                glb(gltf(R"({"mesh":0})",
                         R"({"name":"leaf","alphaMode":"MASK","alphaCutoff":0.5,"normalTexture":{"index":0},
"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[1,0.5,1,1],"metallicFactor":0}})",
                         "", image, 92 + png.size(),
                         fmt::format(",{{\"buffer\":0,\"byteOffset\":92,\"byteLength\":{}}}", png.size())),
                    quad_buffer() + png));
  imported("plant.glb");
  EXPECT_THAT(plant(), AllOf(HasSubstr("\"texture alpha\" \"leaf-alpha\""), HasSubstr("\"string normalmap\"")));
  const Image alpha = read_image(path("scene-files/leaf-alpha.png"), {}).image;
  EXPECT_EQ(alpha.at(0, 0, 0), 1);
  EXPECT_EQ(alpha.at(7, 0, 0), 0);
  // 0.7 in sRGB is 0.4479 in linear values, half of it 0.2239, which is 0.5108 in sRGB.
  EXPECT_NEAR(read_image(path("scene-files/leaf-color.png"), {}).image.at(0, 0, 1), 0.5108f, 0.005f);
}

TEST_F(ImportCommand, DoubleSheetsAreReportedAndRemoved) {
  folder_.write("plant.obj", std::string(kQuad) + "usemtl leaf\nf 1/1 2/2 3/3 4/4\nf 4/4 3/3 2/2 1/1\n");
  EXPECT_THAT(imported("plant.obj").err,
              HasSubstr("\"leaf\" has sheets that are there twice, front and back, in the same place; triangles of the "
                        "second one: 2; --single-sided \"leaf\" removes them"));
  const std::vector<std::string> leaf{"--leaf", "leaf=leaf_lambert"};
  EXPECT_THAT(refusal("plant.obj", {leaf[0], leaf[1], "--strict"}), HasSubstr("light would pass two leaves"));
  const Outcome removed = imported("plant.obj", {leaf[0], leaf[1], "--strict", "--single-sided", "LEAF"});
  EXPECT_THAT(removed.err, HasSubstr("removed"));
  EXPECT_THAT(removed.out, HasSubstr("leaf: leaf_lambert, 2 triangles"));
  EXPECT_THAT(refusal("plant.obj", {"--single-sided", "stem"}), HasSubstr("has no material \"stem\""));
  // The back of a leaf with a normal map has mirrored texture coordinates, and a material of its own.
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl leaf\nnorm leaf.png\n");
  folder_.write("plant.obj",
                std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\nf 4/4 3/3 2/2 1/1\n");
  EXPECT_THAT(refusal("plant.obj", {leaf[0], leaf[1], "--strict"}), HasSubstr("--single-sided \"leaf\" removes them"));
  EXPECT_THAT(imported("plant.obj", {leaf[0], leaf[1], "--strict", "--single-sided", "leaf"}).out,
              HasSubstr("leaf: leaf_lambert, 2 triangles"));
}

TEST_F(ImportCommand, WhatCannotBeMappedIsNamed) {
  folder_.write("plant.gltf",
                gltf(R"({"mesh":0})",
                     R"({"name":"pot","occlusionTexture":{"index":0},"pbrMetallicRoughness":{"roughnessFactor":0.2,
"metallicFactor":0}})",
                     embedded(), R"(,"animations":[{}])"));
  EXPECT_THAT(imported("plant.gltf").err,
              HasSubstr("left out: animation, occlusion map (occlusionTexture) of \"pot\", gloss of \"pot\""));
  folder_.write("bad.mtl", "newmtl leaf\nmap_Kd nowhere.png\nnewmtl stem\nmap_Kd text.png\n");
  folder_.write("text.png", "not an image");
  folder_.write("bad.obj", std::string("mtllib bad.mtl\n") + kQuad + "usemtl leaf\nf 1 2 3\nusemtl stem\nf 1 3 4\n");
  EXPECT_THAT(imported("bad.obj").err, AllOf(HasSubstr("image \"nowhere.png\" is left out: there is no such file"),
                                             HasSubstr("image \"text.png\" is left out: cannot read image")));
}

/// A warning, which is an error in strict mode: then nothing is written.
TEST_F(ImportCommand, LossesAreErrorsInStrictMode) {
  folder_.write("plant.gltf", gltf(R"({"mesh":0})", R"({"name":"pot","extensions":{"KHR_materials_sheen":{}}})",
                                   embedded(), R"(,"extensionsUsed":["KHR_materials_sheen"],"animations":[{},{}])"));
  EXPECT_THAT(imported("plant.gltf").err,
              HasSubstr("warning: left out: animation (2 times), extension KHR_materials_sheen of \"pot\"\n"));
  EXPECT_THAT(refusal("plant.gltf", {"--strict"}), HasSubstr("KHR_materials_sheen"));
  folder_.write("plant.mtl", "newmtl pot\nKs 1 1 1\n");
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl pot\nf 1 2 3\nf 1 2\n");
  EXPECT_THAT(imported("plant.obj").err,
              HasSubstr("left out: face of fewer than 3 corners, first in line 12, gloss of \"pot\"\n"));
  EXPECT_THAT(refusal("plant.obj", {"--strict"}), HasSubstr("gloss of \"pot\""));
  // A leaf material replaces the surface.
  folder_.write("leaf.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl pot\nf 1 2 3\n");
  EXPECT_THAT(imported("leaf.obj", {"--strict", "--leaf", "pot=leaf_lambert"}).err, Not(HasSubstr("left out")));
}

TEST_F(ImportCommand, WhatCannotBeReadIsRefusedWithItsPlace) {
  folder_.write("later.gltf", gltf(R"({"mesh":0})", "{}", embedded(), R"(,"extensionsRequired":["VENDOR_future"])"));
  EXPECT_THAT(refusal("later.gltf"), HasSubstr("not read: VENDOR_future"));
  std::string bytes = gltf(R"({"mesh":0})", "{}", embedded());
  bytes.replace(bytes.find("\"count\":6"), 9, "\"count\":7");
  folder_.write("long.gltf", bytes);
  EXPECT_THAT(refusal("long.gltf"), HasSubstr("indices: its accessor is longer than its bufferView"));
  folder_.write("face.obj", std::string(kQuad) + "f 1 2 9\n");
  EXPECT_THAT(refusal("face.obj"), HasSubstr("line 9: the face has vertex \"9\""));
}

/// Texture coordinates of glTF with the opposite orientation of the vertices, unlike quad_buffer: the y axis of the map
/// is inverted. The scale flattens it; the length of a normal has no effect.
TEST_F(ImportCommand, NormalMapsAreMirroredAndScaled) {
  Image image(2, 2, {"R", "G", "B"});
  image.pixels = {0.8f, 0.6f, 1, 0.8f, 0.6f, 1, 0.8f, 0.6f, 1, 0.8f, 0.6f, 1};
  const auto png = image_codec().encode("normal.png", image, {});
  folder_.write("normal.png", std::string(png.begin(), png.end()));
  const auto map = [this](const std::string& second, const std::string& scale) {
    folder_.write("plant.mtl", "newmtl leaf\nnorm " + scale + " normal.png\n");
    folder_.write("plant.obj", "mtllib plant.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt " + second +
                                   " 0\nvt 0 1\nusemtl leaf\nf 1/1 2/2 3/3\n");
    EXPECT_THAT(imported("plant.obj").err, Not(HasSubstr("warning")));
    const std::string text = plant(), key = "\"string normalmap\" \"";
    const size_t at = text.find(key) + key.size();
    const Image made = read_image(path(text.substr(at, text.find('"', at) - at)), {}).image;
    return std::array{2 * made.at(0, 0, 0) - 1, 2 * made.at(0, 0, 1) - 1, 2 * made.at(0, 0, 2) - 1};
  };
  using ::testing::FloatNear;
  using ::testing::Pointwise;
  EXPECT_THAT(map("1", ""), Pointwise(FloatNear(0.01f), {0.6f, 0.2f, 1.f}));
  EXPECT_THAT(map("-1", ""), Pointwise(FloatNear(0.01f), {0.6f, -0.2f, 1.f}));
  EXPECT_THAT(map("1", "-bm 0.5"), Pointwise(FloatNear(0.01f), {0.3f, 0.1f, 1.f}));
}

/// KHR_materials_diffuse_transmission: 0.4 of the light is transmitted, in a colour of its own.
TEST_F(ImportCommand, DiffuseTransmission) {
  folder_.write("leaf.png", png_with_alpha());
  const auto material = [](const std::string& more) {
    return R"({"name":"leaf","pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[0.5,0.5,0.5,1]},"extensions":{
"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.4,"diffuseTransmissionColorFactor":[0.5,1,0.5])" +
           more + "}}}";
  };
  const std::string images = R"(,"images":[{"uri":"leaf.png"}],"textures":[{"source":0}])";
  folder_.write("plant.gltf", gltf(R"({"mesh":0})", material(""), embedded(), images));
  EXPECT_THAT(imported("plant.gltf", {"--strict"}).out, HasSubstr("leaf: diffusetransmission"));
  EXPECT_THAT(plant(), AllOf(HasSubstr("\"rgb reflectance\" [ 0.3 0.3 0.3 ]"),
                             HasSubstr("\"rgb transmittance\" [ 0.2 0.4 0.2 ]")));
  folder_.write("plant.gltf",
                gltf(R"({"mesh":0})", material(R"(,"diffuseTransmissionTexture":{"index":0})"), embedded(), images));
  imported("plant.gltf", {"--strict"});
  EXPECT_THAT(
      plant(),
      AllOf(HasSubstr("\"mix\" \"rgb tex1\" [ 0.5 0.5 0.5 ] \"rgb tex2\" [ 0 0 0 ] \"texture amount\" \"leaf-share\""),
            HasSubstr("\"mix\" \"rgb tex1\" [ 0 0 0 ] \"rgb tex2\" [ 0.5 1 0.5 ]")));
  const Image share = read_image(path("scene-files/leaf-transmission.png"), {}).image;
  EXPECT_NEAR(share.at(0, 0, 0), 0.4f, 0.003f);
  EXPECT_NEAR(share.at(7, 0, 0), 0.4f * 0.3f, 0.003f);
}

/// A camera that looks along -z of glTF, which is +y of the scene, from (0.5, 1, 5); a spot turned to -x; a
/// quadrilateral that emits, of which there are two. Lengths are doubled: an intensity is 4 times as large.
TEST_F(ImportCommand, CameraLightsAndEmission) {
  const std::string half = std::to_string(std::sqrt(0.5));
  folder_.write(
      "plant.gltf",
      gltf(R"({"children":[1,2,3,4,5]},{"mesh":0},{"mesh":0,"translation":[2,0,0]},{"camera":0,"translation":[0.5,1,5]},
{"extensions":{"KHR_lights_punctual":{"light":0}},"rotation":[0,)" +
               half + ",0," + half + R"(]},{"extensions":{"KHR_lights_punctual":{"light":1}}})",
           R"({"name":"lamp","doubleSided":true,"emissiveFactor":[1,0.5,0],"extensions":
{"KHR_materials_emissive_strength":{"emissiveStrength":4}}})",
           embedded(), R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.4,"znear":1,
"aspectRatio":2}}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":3},
{"type":"directional","color":[1,0,0],"intensity":7}]}})"));
  const Outcome o = imported("plant.gltf", {"--strict", "--scale", "2"});
  EXPECT_THAT(o.out, AllOf(HasSubstr("the model's camera\n2 lights in place of sun and sky\n"),
                           HasSubstr("lamp: diffuse, 4 triangles")));
  EXPECT_THAT(
      text_of(path("scene.pbrt")),
      AllOf(HasSubstr("LookAt 1 -10 2   1 -9 2   0 0 1\nCamera \"perspective\" \"float fov\" 22.918"),
            HasSubstr("\"integer xresolution\" 800 \"integer yresolution\" 400"),
            HasSubstr("LightSource \"spot\" \"rgb I\" [ 12 12 12 ] \"point3 from\" [ 0 0 0 ] \"point3 to\" [ -1 "),
            HasSubstr("\"float coneangle\" 45 \"float conedeltaangle\" 45\n"),
            HasSubstr("LightSource \"distant\" \"rgb L\" [ 7 0 0 ]"), Not(HasSubstr("sky"))));
  EXPECT_THAT(plant(), AllOf(HasSubstr("AreaLightSource \"diffuse\" \"rgb L\" [ 4 2 0 ] \"bool twosided\" true\n"),
                             Not(HasSubstr("ObjectInstance"))));
}

/// The image of an emission, and Ke as its factor. Coordinates beyond the image are clamped in an area light.
TEST_F(ImportCommand, EmissionByAnImage) {
  folder_.write("glow.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl lamp\nmap_Ke glow.png\nKe 3 3 3\nd 1\n");
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl lamp\nf 1/1 2/2 3/3 4/4\n");
  EXPECT_THAT(imported("plant.obj", {"--strict"}).err, Not(HasSubstr("left out")));
  EXPECT_THAT(plant(), HasSubstr("AreaLightSource \"diffuse\" \"string filename\" \"scene-files/glow.png\" \"float "
                                 "scale\" 3 \"bool twosided\" true\n"));
  folder_.write("plant.mtl", "newmtl lamp\nmap_Ke -s 2 2 glow.png\n");
  EXPECT_THAT(imported("plant.obj").err, HasSubstr("left out: repetition of the image of the emission of \"lamp\""));
  folder_.write("plant.mtl", "newmtl lamp\nmap_Ke nowhere.png\n");
  EXPECT_THAT(imported("plant.obj").err, HasSubstr("image \"nowhere.png\" is left out"));
  EXPECT_THAT(plant(), Not(HasSubstr("AreaLightSource")));
}

TEST_F(ImportCommand, ClearSurfaces) {
  const auto material = [](const std::string& more) {
    return R"({"name":"dew","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0},"extensions":{
"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.33})" +
           more + "}}";
  };
  folder_.write("plant.gltf", gltf(R"({"mesh":0})", material(""), embedded()));
  EXPECT_THAT(imported("plant.gltf", {"--strict"}).out, HasSubstr("dew: thindielectric"));
  folder_.write("plant.gltf",
                gltf(R"({"mesh":0})", material(R"(,"KHR_materials_volume":{"thicknessFactor":1})"), embedded()));
  EXPECT_THAT(imported("plant.gltf", {"--strict"}).out, HasSubstr("dew: dielectric"));
  EXPECT_THAT(plant(), HasSubstr("\"float eta\" 1.33"));
}

/// An opacity map with a scale of its own, beside an image of the colour without.
TEST_F(ImportCommand, ImagesWithTextureCoordinatesOfTheirOwn) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.mtl", "newmtl leaf\nmap_Kd -s 2 2 -o 0.5 0 leaf.png\nmap_d -s 4 2 map.png\n");
  folder_.write("map.png", png_with_alpha());
  folder_.write("plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  EXPECT_THAT(imported("plant.obj").err, Not(HasSubstr("warning")));
  EXPECT_THAT(plant(), HasSubstr("\"float uscale\" 2 \"float udelta\" -1 \"float vscale\" 1 \"float vdelta\" 0"));
}

TEST_F(ImportCommand, ImagesInFoldersThatTheUserNames) {
  folder_.write("art/Leaf.PNG", png_with_alpha());
  folder_.write("obj/plant.mtl", "newmtl leaf\nmap_Kd ../textures/leaf.png\n");
  folder_.write("obj/plant.obj", std::string("mtllib Plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  EXPECT_THAT(imported("obj/plant.obj").err, HasSubstr("the option textures names"));
  EXPECT_THAT(imported("obj/plant.obj", {"--textures", path("art")}).err, Not(HasSubstr("warning")));
  EXPECT_EQ(text_of(path("scene-files/leaf.png")), png_with_alpha());
  EXPECT_THAT(refusal("obj/plant.obj", {"--textures", path("none")}), HasSubstr("none\""));
}

TEST_F(ImportCommand, NamesInGltfArePercentEncoded) {
  folder_.write("the leaf.png", png_with_alpha());
  folder_.write("the data.bin", quad_buffer());
  folder_.write(
      "plant.gltf",
      gltf(R"({"mesh":0})", R"({"name":"leaf","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})",
           R"("uri":"the%20data.bin",)", R"(,"images":[{"uri":"the%20leaf.png"}],"textures":[{"source":0}])"));
  EXPECT_THAT(imported("plant.gltf").err, Not(HasSubstr("warning")));
  EXPECT_THAT(plant(), HasSubstr("\"string filename\" \"scene-files/the_leaf.png\""));
  EXPECT_EQ(text_of(path("scene-files/the_leaf.png")), png_with_alpha());
}

/// The diffuse colour of KHR_materials_pbrSpecularGlossiness is used, with its factor.
TEST_F(ImportCommand, SpecularAndGlossiness) {
  folder_.write("leaf.png", png_with_alpha());
  folder_.write("plant.gltf",
                gltf(R"({"mesh":0})", R"({"name":"leaf","extensions":{"KHR_materials_pbrSpecularGlossiness":
{"diffuseTexture":{"index":0},"diffuseFactor":[1,0.5,1,1]}}})",
                     embedded(), R"(,"images":[{"uri":"leaf.png"}],"textures":[{"source":0}],
"extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],"extensionsRequired":["KHR_materials_pbrSpecularGlossiness"])"));
  EXPECT_THAT(imported("plant.gltf").err, HasSubstr("left out: gloss of \"leaf\""));
  EXPECT_NEAR(read_image(path("scene-files/leaf-color.png"), {}).image.at(0, 0, 1), 0.5108f, 0.005f);
}

/// Materials that make the same image of one share it.
TEST_F(ImportCommand, DerivedImagesAreMadeOnce) {
  folder_.write("leaf.png", png_with_alpha());
  const auto material = [](const std::string& name) {
    return R"({"name":")" + name + R"(","alphaMode":"MASK","pbrMetallicRoughness":
{"baseColorTexture":{"index":0},"baseColorFactor":[1,0.5,1,1],"metallicFactor":0}})";
  };
  std::string text = gltf(R"({"mesh":0})", material("a") + "," + material("b"), embedded(),
                          R"(,"images":[{"uri":"leaf.png"}],"textures":[{"source":0}])");
  const std::string primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0})";
  std::string other = primitive;
  other.replace(other.size() - 2, 1, "1");
  text.replace(text.find(primitive), primitive.size(), primitive + "," + other);
  folder_.write("plant.gltf", text);
  imported("plant.gltf");
  std::set<std::string> images;
  for (const auto& entry : fs::directory_iterator(path("scene-files")))
    if (entry.path().extension() == ".png") images.insert(entry.path().filename().string());
  EXPECT_THAT(images, ::testing::ElementsAre("a-alpha.png", "a-color.png"));
  EXPECT_THAT(plant(), AllOf(HasSubstr("\"b-alpha\""), HasSubstr("\"b-color\"")));
}

/// 854 bytes took 146 s: the cells of the search depended on the stretch of the instances.
TEST_F(ImportCommand, StretchedInstancesAreSearched) {
  folder_.write("plant.gltf", gltf(R"({"children":[1,2]},{"mesh":0,"scale":[1,1,1e6]},{"mesh":0,"scale":[1,1,1e6]})",
                                   "{}", embedded()));
  EXPECT_THAT(imported("plant.gltf").out, HasSubstr("2 instances of 1 object"));
}

/// If a file cannot be moved into place, the old files are restored and no new ones remain.
TEST_F(ImportCommand, AllOrNothingIsWritten) {
  folder_.write("plant.obj", std::string(kQuad) + "usemtl leaf\nf 1 2 3\n");
  fs::create_directories(path("refused-plant.pbrt/x"));
  EXPECT_THAT(refusal("plant.obj"), HasSubstr("it is a folder"));
  folder_.write("refused-files/leaf.ply", "old");
  EXPECT_THAT(refusal("plant.obj"), HasSubstr("it is a folder"));
  EXPECT_EQ(text_of(path("refused-files/leaf.ply")), "old");
  fs::remove_all(path("refused-plant.pbrt"));
  fs::remove_all(path("refused-files"));
  folder_.write("refused-files", "a file");
  EXPECT_THAT(refusal("plant.obj"), HasSubstr("a folder is needed"));
}

TEST_F(ImportCommand, LineEndsInNamesAreEscaped) {
  folder_.write(
      "plant.gltf",
      gltf(R"({"mesh":0})", R"({"name":"leaf","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", embedded(),
           R"(,"images":[{"uri":"a\n\u001b[2Jfrond: all is well.png"}],"textures":[{"source":0}])"));
  EXPECT_THAT(imported("plant.gltf").err, HasSubstr("image \"a\\n\\x1b[2Jfrond: all is well.png\" is left out"));
}

TEST_F(ImportCommand, FilesOutsideTheFolderAreNotRead) {
  const std::string secret = folder_.write("secret/quad.bin", quad_buffer()).string();
  const std::string nodes = "{\"mesh\":0}", material = "{\"name\":\"leaf\"}";
  for (const std::string& uri : {std::string("../secret/quad.bin"), secret, "file://" + secret,
                                 std::string("http://localhost/quad.bin"), std::string("..\\\\secret\\\\quad.bin")}) {
    folder_.write("model/plant.gltf", gltf(nodes, material, "\"uri\":\"" + uri + "\","));
    EXPECT_THAT(refusal("model/plant.gltf"), HasSubstr("plant.gltf\"")) << uri;
  }
  fs::create_symlink(secret, path("model/link.bin"));
  folder_.write("model/plant.gltf", gltf(nodes, material, "\"uri\":\"link.bin\","));
  EXPECT_THAT(refusal("model/plant.gltf"), HasSubstr("it is outside the model's folder"));
  folder_.write("secret/leaf.png", png_with_alpha());
  folder_.write("model/plant.mtl", "newmtl leaf\nmap_Kd ../secret/leaf.png\n");
  folder_.write("model/plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3\n");
  EXPECT_THAT(imported("model/plant.obj").err, HasSubstr("image \"../secret/leaf.png\" is left out"));
  EXPECT_FALSE(fs::exists(path("scene-files/leaf.png")));
}

TEST_F(ImportCommand, DamagedFilesAreErrors) {
  const std::string good = glb(gltf("{\"mesh\":0}", "{\"name\":\"leaf\"}", ""), quad_buffer());
  for (const size_t size : {0u, 3u, 12u, 20u, 100u, unsigned(good.size()) / 2, unsigned(good.size()) - 40}) {
    folder_.write("cut.glb", good.substr(0, size));
    EXPECT_THAT(refusal("cut.glb"), HasSubstr("cannot read \"")) << size;
  }
  const auto gltf_error = [this](const std::string& text) {
    folder_.write("bad.gltf", text);
    return refusal("bad.gltf");
  };
  EXPECT_THAT(gltf_error("{"), HasSubstr("bad.gltf"));
  EXPECT_THAT(gltf_error(gltf(R"({"mesh":0,"children":[1]},{"mesh":0,"children":[0]})", "{}", embedded())),
              HasSubstr("has two parents"));
  std::string huge = gltf("{\"mesh\":0}", "{}", embedded());
  for (size_t at; (at = huge.find("\"count\":4,")) != std::string::npos;) huge.replace(at, 10, "\"count\":2000000000,");
  EXPECT_THAT(gltf_error(huge), HasSubstr("bad.gltf"));
  folder_.write("points.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n");
  EXPECT_THAT(refusal("points.obj"), HasSubstr("it has no triangles; of a point cloud"));
  folder_.write("far.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\nf 1 2 9\n");
  EXPECT_THAT(refusal("far.obj"), HasSubstr("far.obj"));
}

TEST_F(ImportCommand, ArgumentsAreChecked) {
  folder_.write("plant.fbx", "x");
  EXPECT_THAT(refusal("plant.fbx"), HasSubstr("models are .obj, .gltf or .glb files"));
  EXPECT_THAT(refusal("none.obj"), HasSubstr("there is no such file"));
  folder_.write("plant.obj", std::string(kQuad) + "f 1 2 3\n");
  EXPECT_THAT(frond_command({"import", path("plant.obj"), "-o", path("plant.txt")}).err,
              HasSubstr("needs the extension .pbrt"));
}

/// Names in untrusted files cannot become directives.
TEST_F(ImportCommand, NamesAreQuoted) {
  folder_.write("a\nInclude \"x\".obj", std::string(kQuad) + "usemtl a\"b\\c\nf 1 2 3\nusemtl \xff\nf 1 3 4\n");
  imported("a\nInclude \"x\".obj");
  EXPECT_THAT(plant(), AllOf(HasSubstr("import a_Include \"x\".obj"), HasSubstr("MakeNamedMaterial \"a_b_c\""),
                             HasSubstr("MakeNamedMaterial \"_\"")));
}

/// The folder of the files to write is the folder of the model's images.
TEST_F(ImportCommand, InputsAreNotReplaced) {
  folder_.write("refused-files/leaf.png", png_with_alpha());
  folder_.write("refused-files/plant.mtl", "newmtl leaf\nmap_Kd leaf.png\n");
  folder_.write("refused-files/plant.obj", std::string("mtllib plant.mtl\n") + kQuad + "usemtl leaf\nf 1/1 2/2 3/3\n");
  EXPECT_THAT(refusal("refused-files/plant.obj"), HasSubstr("would replace the input"));
}

}  // namespace
}  // namespace frond
