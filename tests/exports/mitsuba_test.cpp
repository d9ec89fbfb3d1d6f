// Export of scenes to Mitsuba: the written files, and errors with their position.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "exports/mitsuba/scene_export.h"
#include "image/image_file.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "system/file_bytes.h"
#include "system/tensor_file.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class MitsubaScene : public ::testing::Test {
 protected:
  /// Keeps the warnings.
  struct Warnings final : Log {
    void info(std::string_view) const override {}
    void warn(const Location& where, std::string_view message) const override {
      all.push_back(where.text() + std::string(message));
    }
    mutable std::vector<std::string> all;
  };
  /// Exports the scene and returns scene.xml.
  std::string exported(const std::string& scene, const std::vector<double>& nm = {}, const std::string& ignored = "",
                       const Log& log = silent_log()) const {
    ThreadPool pool(1);
    export_to_mitsuba(parse_scene_text(scene, FROND_SOURCE_DIR "/tests/pbrt_reference/s.pbrt", silent_log()),
                      make_registry(builtin_materials(), builtin_integrators()),
                      {folder_.name_of("out"), nm, "s.pbrt", ignored.empty() ? Unsupported() : Unsupported(ignored)},
                      pool, log, {});
    return read_file_bytes(folder_.name_of("out/scene.xml"), {});
  }
  /// Writes a float image of 2 x 2 texels in three channels, and returns the quoted path.
  std::string image(const std::string& name, const std::vector<float>& texels) const {
    Image image(2, 2, {"R", "G", "B"});
    image.pixels = texels;
    write_image(folder_.name_of(name), image, {});
    return '"' + folder_.name_of(name) + '"';
  }
  /// Reads the image of the named texture in scene.xml.
  Image texture(const std::string& xml, const std::string& name) const {
    size_t at = xml.find("<texture name=\"" + name + "\"");
    EXPECT_NE(at, std::string::npos) << name << xml;
    constexpr std::string_view kBegin = "name=\"filename\" value=\"";
    at = xml.find(kBegin, at) + kBegin.size();
    return read_image(folder_.name_of("out/" + xml.substr(at, xml.find('"', at) - at)), {}).image;
  }
  std::string refusal(const std::string& scene, const std::vector<double>& nm = {}) const {
    return error_of([&] { (void)exported(scene, nm); });
  }
  static std::string world(const std::string& shapes) {
    return "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter "
           "\"box\" WorldBegin\n"
           "LightSource \"infinite\"\n" +
           shapes;
  }

  TestFolder folder_{"mitsuba"};
};

/// The matrices of the elements that have one, in the order of the file, by rows.
std::vector<std::array<double, 16>> matrices(const std::string& xml) {
  std::vector<std::array<double, 16>> found;
  constexpr std::string_view kBegin = "<matrix value=";
  for (size_t at = 0; (at = xml.find(kBegin, at)) != std::string::npos;) {
    at += kBegin.size() + 1;
    std::istringstream numbers(xml.substr(at, 1000));
    for (double& v : found.emplace_back()) numbers >> v;
  }
  return found;
}

TEST_F(MitsubaScene, WhatHasNoEquivalentIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal("ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\nCamera \"perspective\"\n"
                      "PixelFilter \"box\"\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n"),
              HasSubstr("s.pbrt:4:8: a camera that moves has no equivalent in Mitsuba"));
  const std::string moving = "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\n";
  EXPECT_THAT(refusal(world(moving + "  Shape \"sphere\"\n")),
              ContainsRegex("s.pbrt:8:[0-9]+: what moves has no equivalent in Mitsuba"));
  EXPECT_THAT(refusal(world("ObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\n" + moving + "ObjectInstance \"o\"\n")),
              ContainsRegex("s.pbrt:11:[0-9]+: what moves has no equivalent in Mitsuba"));
  EXPECT_THAT(refusal(world("  Material \"coateddiffuse\"\nShape \"sphere\"\n")),
              HasSubstr("s.pbrt:5:12: material \"coateddiffuse\" has no equivalent in Mitsuba"));
  EXPECT_THAT(refusal(world("MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\nMediumInterface \"m\" \"\"\n"
                            "Shape \"sphere\"\n")),
              HasSubstr("s.pbrt:5:35: participating media are not exported"));
  EXPECT_THAT(refusal(world("Scale 1 2 1\nShape \"sphere\"\n")),
              HasSubstr("s.pbrt:6:7: a sphere whose transform stretches it has no equivalent"));
  EXPECT_FALSE(std::filesystem::exists(folder_.name_of("out/scene.xml")));
}

// frond's camera looks along +z with x to the right; Mitsuba's has x to the left. One unit of the scene is 100 here:
// its radius is sqrt(3).
TEST_F(MitsubaScene, ACameraKeepsItsPlaceAndItsSides) {
  const std::string xml = exported("LookAt 1 2 3  1 2 10  0 1 0\n" + world("Shape \"sphere\"\n"));
  const auto m = matrices(xml);
  ASSERT_FALSE(m.empty());
  const std::array<double, 16> expected{-1, 0, 0, 100, 0, 1, 0, 200, 0, 0, 1, 300, 0, 0, 0, 1};
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(m[0][i], expected[i], 1e-4) << i;
  EXPECT_THAT(xml, HasSubstr("<float name=\"fov\" value=\"90\"/>"));
  const auto mirrored = matrices(exported("Scale -1 1 1\n" + world("Shape \"sphere\"\n")));
  EXPECT_NEAR(mirrored[0][0], 1, 1e-6);
}

// Independent numbers would have several times the variance of frond's own.
TEST_F(MitsubaScene, TheSamplerIsStratifiedUnlessTheSceneAsksForIndependentNumbers) {
  EXPECT_THAT(exported(world("Shape \"sphere\"\n")), HasSubstr("<sampler type=\"multijitter\">"));
  EXPECT_THAT(exported("Sampler \"independent\"\n" + world("Shape \"sphere\"\n")),
              HasSubstr("<sampler type=\"independent\">"));
}

TEST_F(MitsubaScene, AHiddenBackgroundIsHidden) {
  EXPECT_THAT(exported("Integrator \"path\" \"bool hidebackground\" true\n" + world("Shape \"sphere\"\n")),
              HasSubstr("<boolean name=\"hide_emitters\" value=\"true\"/>"));
  EXPECT_THAT(exported(world("Shape \"sphere\"\n")), Not(HasSubstr("hide_emitters")));
}

// Instances of instances become instances of the innermost object, with the product of their transforms.
TEST_F(MitsubaScene, NestedInstancesAreWrittenWithoutNesting) {
  const std::string xml = exported(world(R"(
ObjectBegin "inner"
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 0  100 0 0  0 100 0]
ObjectEnd
ObjectBegin "outer"
Translate 10 0 0
ObjectInstance "inner"
Scale -1 1 1
ObjectInstance "inner"
ObjectEnd
Scale 2 2 2
ObjectInstance "outer"
)"));
  const auto m = matrices(xml);
  ASSERT_THAT(m, SizeIs(3)) << "the camera and two instances";
  EXPECT_NEAR(m[1][0] / m[1][5], 1, 1e-6);
  EXPECT_NEAR(m[2][0] / m[2][5], -1, 1e-6) << "mirrored";
  for (size_t i : {1u, 2u}) EXPECT_NEAR(m[i][3] / m[i][5], 10, 1e-5) << "2 (x + 10), over the scale";
  size_t groups = 0;
  for (size_t at = 0; (at = xml.find("\"shapegroup\"", at)) != std::string::npos; ++at) ++groups;
  EXPECT_EQ(groups, 1u);
}

// An orientation that is reversed or mirrored is flipped; with both it is not.
TEST_F(MitsubaScene, ReverseOrientationFlipsNormals) {
  const std::string flipped = "\"flip_normals\" value=\"true\"", plain = "\"flip_normals\" value=\"false\"";
  EXPECT_THAT(exported(world("Shape \"sphere\"\n")), HasSubstr(plain));
  EXPECT_THAT(exported(world("ReverseOrientation\nShape \"sphere\"\n")), HasSubstr(flipped));
  EXPECT_THAT(exported(world("Scale -1 1 1\nReverseOrientation\nShape \"sphere\"\n")), HasSubstr(plain));
}

TEST_F(MitsubaScene, ATensorFileIsWrittenForItsVariants) {
  const std::string metal = world("Material \"measured\" \"string filename\" \"metal.bsdf\"\nShape \"sphere\"\n");
  const auto written = [&](const std::vector<double>& nm) {
    const std::string xml = exported(metal, nm);
    EXPECT_THAT(xml, HasSubstr("type=\"measured\""));
    const size_t at = xml.find("measured/metal-");
    const std::string file = folder_.name_of("out/" + xml.substr(at, xml.find('"', at) - at));
    return TensorFile(read_file_bytes(file, {}), file, {});
  };
  const std::string path = FROND_SOURCE_DIR "/tests/pbrt_reference/metal.bsdf";
  const TensorFile original(read_file_bytes(path, {}), path, {});
  const auto same = [&](const TensorFile& file, std::string_view name, size_t dimensions) {
    return file.numbers(file.floats(name, dimensions)) == original.numbers(original.floats(name, dimensions));
  };
  const TensorFile spectral = written({360, 500, 600, 830});
  EXPECT_TRUE(same(spectral, "spectra", 5) && same(spectral, "wavelengths", 1) && same(spectral, "vndf", 4));
  // The file has 360, 595 and 830 nm.
  const TensorFile rgb = written({830, 595, 477.5});
  EXPECT_FALSE(rgb.has("spectra"));
  EXPECT_TRUE(same(rgb, "luminance", 4));
  const auto colors = rgb.numbers(rgb.floats("rgb", 5)), spectra = original.numbers(original.floats("spectra", 5));
  ASSERT_EQ(colors.size(), spectra.size());
  const size_t texels = original.floats("spectra", 5).shape[4] * original.floats("spectra", 5).shape[4];
  for (size_t i = 0; i < spectra.size() / 3; ++i) {
    const size_t at = i / texels * 3 * texels + i % texels;
    EXPECT_EQ(colors[at], spectra[at + 2 * texels]);
    EXPECT_EQ(colors[at + texels], spectra[at + texels]);
    EXPECT_FLOAT_EQ(colors[at + 2 * texels], (spectra[at] + spectra[at + texels]) / 2);
  }
  EXPECT_THAT(refusal(metal, {550}), HasSubstr("s.pbrt:5:39: Mitsuba's measured BSDF is not for mono variants"));
  EXPECT_THAT(refusal(world("Material \"measured\" \"string filename\" \"brushed.bsdf\"\nShape \"sphere\"\n")),
              HasSubstr("s.pbrt:5:39: an anisotropic measurement is not exported"));
}

constexpr const char* kCard =
    "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\n";

/// Each has its place, and no folder remains.
TEST_F(MitsubaScene, AllObstaclesAreReportedAtOnce) {
  const std::string scene =
      "Camera \"spherical\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nIntegrator \"volpath\"\n"
      "WorldBegin\nLightSource \"sky\"\nLightSource \"goniometric\" \"string filename\" " +
      image("white.exr", std::vector<float>(12, 1)) +
      "\nTexture \"t\" \"spectrum\" \"checkerboard\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + kCard +
      "Material \"coateddiffuse\"\nShape \"sphere\"\n"
      "Material \"conductor\" \"float uroughness\" 0.1 \"float vroughness\" 0.2\nShape \"sphere\" \"float phimax\" "
      "90\n" +
      kCard;
  const std::string message = refusal(scene);
  EXPECT_THAT(
      message,
      AllOf(HasSubstr("s.pbrt:1:8: camera \"spherical\""), HasSubstr("s.pbrt:3:12: integrator \"volpath\""),
            HasSubstr("s.pbrt:5:13: light \"sky\""), HasSubstr("s.pbrt:6:13: light \"goniometric\""),
            HasSubstr("s.pbrt:7:24: texture \"checkerboard\""), HasSubstr("s.pbrt:10:10: material \"coateddiffuse\"")));
  EXPECT_THAT(message,
              AllOf(HasSubstr("s.pbrt:12:10: a roughness that differs"), HasSubstr("s.pbrt:13:31: part of a sphere")));
  EXPECT_EQ(std::ranges::count(message, '\n'), 7) << message;
  EXPECT_FALSE(std::filesystem::exists(folder_.name_of("out")));
  // With the option each is a warning.
  const Warnings log;
  const std::string xml = exported(scene, {}, "all", log);
  for (const char* what : {"1:8: camera", "3:12: integrator", "5:13: light", "6:13: light", "7:24: texture",
                           "10:10: material", "12:10: a roughness", "13:31: part"})
    EXPECT_THAT(log.all, ::testing::Contains(HasSubstr(what)));
  EXPECT_THAT(log.all, Each(Not(HasSubstr("--ignore"))));
  EXPECT_THAT(xml, AllOf(HasSubstr("type=\"directional\""), HasSubstr("type=\"envmap\""),
                         HasSubstr("type=\"frond_diffuse\" id=\"material-2\"")));
  // Listed kinds only.
  EXPECT_THAT(refusal(scene, {}), HasSubstr("coateddiffuse"));
  const std::string some = error_of([&] { (void)exported(scene, {}, "materials,textures"); });
  EXPECT_THAT(some, AllOf(Not(HasSubstr("coateddiffuse")), Not(HasSubstr("checkerboard")), HasSubstr("light \"sky\"")));
}

/// The map is outside of "twosided", which would mirror it on the back; its texels are the file's.
TEST_F(MitsubaScene, NormalMapsAreExported) {
  const std::vector<float> normals{0.5f, 0.5f, 1, 0.6f, 0.5f, 0.9f, 0.5f, 0.4f, 0.9f, 0.4f, 0.6f, 0.9f};
  const std::string xml =
      exported(world("Material \"diffuse\" \"string normalmap\" " + image("normals.exr", normals) + "\n" + kCard));
  EXPECT_THAT(xml, ContainsRegex("type=\"normalmap\" id=\"material-1\">[^$]*type=\"twosided\">[^$]*type=\"diffuse\""));
  EXPECT_THAT(xml, HasSubstr("<matrix value=\"1 0 0 0 0 -1 0 1 0 0 1 0 0 0 0 1\"/>"));
  EXPECT_EQ(texture(xml, "normalmap").pixels, normals);
  EXPECT_THAT(refusal(world("Material \"diffuse\" \"string normalmap\" " + image("normals.exr", normals) +
                            "\nShape \"sphere\"\n")),
              HasSubstr("images on a sphere are not exported"));
}

/// Heights are in the scene's units, of which one is 100 here.
TEST_F(MitsubaScene, BumpMapsAreExported) {
  const std::string heights = image("heights.exr", {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1});
  const std::string xml =
      exported(world("Texture \"h\" \"float\" \"imagemap\" \"string filename\" " + heights +
                     " \"float scale\" 0.25\nMaterial \"diffuse\" \"texture displacement\" \"h\"\n" + kCard));
  EXPECT_THAT(xml, AllOf(HasSubstr("type=\"bumpmap\" id=\"material-1\""), HasSubstr("name=\"scale\" value=\"100\"")));
  EXPECT_EQ(texture(xml, "map").at(1, 0, 0), 0.25f);
  EXPECT_THAT(exported(world("Texture \"h\" \"float\" \"constant\" \"float value\" 2\nMaterial \"diffuse\" \"texture "
                             "displacement\" \"h\"\n" +
                             std::string(kCard))),
              Not(HasSubstr("bumpmap")));
}

/// Products and mixtures of images with one mapping are images; others are rejected or replaced by their mean.
TEST_F(MitsubaScene, TexturesOfImagesAreTabulated) {
  const std::string image = this->image("map.exr", {0, 0, 0, 1, 1, 1, 0.5f, 0.5f, 0.5f, 0.25f, 0.25f, 0.25f});
  const auto leaf = [&](const std::string& more) {
    return world("Texture \"i\" \"float\" \"imagemap\" \"string filename\" " + image +
                 " \"string filter\" \"point\"\n"
                 "Texture \"t\" \"float\" \"mix\" \"float tex1\" 1 \"float tex2\" 5 \"texture amount\" \"i\"\n" +
                 more + kCard);
  };
  const std::string xml = exported(leaf("Material \"leaf_solved\" \"texture chlorophylla\" \"t\"\n"));
  EXPECT_THAT(texture(xml, "chlorophylla").pixels, ::testing::ElementsAre(1, 5, 3, 2));
  const std::string other =
      leaf("Texture \"j\" \"float\" \"imagemap\" \"string filename\" " + image +
           " \"float uscale\" 2\nTexture \"s\" \"float\" \"scale\" \"texture tex\" \"t\" \"texture scale\" \"j\"\n"
           "Material \"leaf_solved\" \"texture chlorophylla\" \"s\"\n");
  EXPECT_THAT(refusal(other), HasSubstr("images with different mappings"));
}

/// The shares of each texel equal the shares of a leaf with its chlorophyll.
TEST_F(MitsubaScene, ALambertianLeafFollowsItsTextures) {
  const std::string image = this->image("map.exr", {2, 2, 2, 4, 4, 4, 2, 2, 2, 4, 4, 4});
  const std::string xml = exported(world("Texture \"t\" \"float\" \"imagemap\" \"string filename\" " + image +
                                         " \"string filter\" \"point\"\nMaterial \"leaf_lambert\" \"texture "
                                         "chlorophylla\" \"t\"\n" +
                                         kCard));
  const Image reflectance = texture(xml, "reflectance"), back = texture(xml, "back_transmittance");
  const std::string constant =
      exported(world("Material \"leaf_lambert\" \"float chlorophylla\" 4\n" + std::string(kCard)));
  const size_t at = constant.find("<rgb name=\"reflectance\" value=\"");
  double red = 0, green = 0;
  ASSERT_EQ(std::sscanf(constant.c_str() + at, "<rgb name=\"reflectance\" value=\"%lf, %lf", &red, &green), 2);
  EXPECT_NEAR(double(reflectance.at(1, 0, 1)), green, 2e-3) << "interpolated over the depth";
  EXPECT_NEAR(double(reflectance.at(1, 0, 0)), red, 2e-3);
  EXPECT_GT(reflectance.at(0, 0, 1), reflectance.at(1, 0, 1) + 0.01f);
  EXPECT_GT(back.at(0, 0, 1), back.at(1, 0, 1) + 0.01f);
}

/// Mitsuba takes one environment.
TEST_F(MitsubaScene, SurroundingLightsAreOneEmitter) {
  const auto count = [](const std::string& xml, const std::string& what) {
    size_t n = 0;
    for (size_t at = 0; (at = xml.find(what, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  const std::string two = exported(world("LightSource \"infinite\"\nShape \"sphere\"\n"));
  EXPECT_EQ(count(two, "type=\"constant\""), 1u);
  const std::string sky = exported(world("LightSource \"sky\"\nShape \"sphere\"\n"), {}, "all");
  EXPECT_EQ(count(sky, "type=\"constant\""), 0u);
  EXPECT_EQ(count(sky, "type=\"envmap\""), 1u);
}

}  // namespace
}  // namespace frond
