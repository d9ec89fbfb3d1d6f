// Export of scenes to Mitsuba: what is written, and refusals with their position.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "exports/mitsuba/scene_export.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "system/file_bytes.h"
#include "system/tensor_file.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class MitsubaScene : public ::testing::Test {
 protected:
  /// Exports the scene and returns scene.xml.
  std::string exported(const std::string& scene, const std::vector<double>& nm = {}) const {
    ThreadPool pool(1);
    export_to_mitsuba(parse_scene_text(scene, FROND_SOURCE_DIR "/tests/pbrt_reference/s.pbrt", silent_log()),
                      make_registry(builtin_materials(), builtin_integrators()), {folder_.name_of("out"), nm, "s.pbrt"},
                      pool, silent_log(), {});
    return read_file_bytes(folder_.name_of("out/scene.xml"), {});
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

}  // namespace
}  // namespace frond
