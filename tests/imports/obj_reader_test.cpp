#include "models/obj_reader.h"

#include <gmock/gmock.h>

#include "models/polygon.h"
#include "tests/imports/model_test.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using P = std::array<float, 3>;
using T = std::array<uint32_t, 3>;

/// Reads an OBJ file, and a material file that it names.
ImportedScene read_obj(const std::string& obj, const std::string& mtl = "") {
  FilesInMemory files(mtl.empty() ? std::map<std::string, std::string>()
                                  : std::map<std::string, std::string>{{"a.mtl", mtl}});
  return read_obj(mtl.empty() ? obj : "mtllib a.mtl\n" + obj, "model.obj", files);
}
std::vector<std::string> losses_of_obj(const std::string& obj, const std::string& mtl = "newmtl m\n") {
  return texts_of(read_obj(obj, mtl).losses);
}
std::string refusal_of_obj(const std::string& obj) {
  return refusal_by([&] { read_obj(obj); });
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", kMaterial = kTriangle + "usemtl m\nf 1 2 3\n";

TEST(ObjReader, StatementsThatAreRead) {
  const ImportedScene scene = read_obj(
      "o a\n# x\n\nv 0 0 0 2\nv .5 -.05 +1e0\nv 0 1,5 0 # y\nvt 1\nvn 0 0 1\ng b c\ns off\nf 1/1/1 2/1/1 3/1/1\n");
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_THAT(scene.meshes[0].positions, ElementsAre(P{0, 0, 0}, P{0.5f, -0.05f, 1}, P{0, 1.5f, 0}));
  EXPECT_EQ(scene.meshes[0].uvs[0], (std::array<float, 2>{1, 0}));
  EXPECT_EQ(scene.meshes[0].normals[0], (P{0, 0, 1}));
  EXPECT_EQ(scene.nodes[0].name, "b c");
  EXPECT_EQ(scene.materials[0].name, "DefaultMaterial");
  EXPECT_THAT(scene.losses, IsEmpty());
}

TEST(ObjReader, FacesInAllForms) {
  const std::string head = kTriangle + "vt 0 0\nvn 0 0 1\nusemtl m\n";
  const auto mesh = [&head](const std::string& words) { return read_obj(head + "f " + words + "\n").meshes.at(0); };
  EXPECT_THAT(mesh("01 +2 3").positions, ElementsAre(P{0, 0, 0}, P{1, 0, 0}, P{0, 1, 0}));
  EXPECT_EQ(mesh("-3/-1 -2/-1 -1/-1").uvs.size(), 3u);
  EXPECT_EQ(mesh("1//1 2//1 3//1").normals.size(), 3u);
  EXPECT_THAT(mesh("1//1 2//1 3//1").uvs, IsEmpty());
  EXPECT_THAT(mesh("1/1 2 3/1").uvs, IsEmpty());
  EXPECT_EQ(read_obj(kTriangle + "f 1 2 \\\n 3\n").meshes[0].triangles.size(), 1u);
  EXPECT_THAT(read_obj("f 1 2 3\r\nv 0 0 0\r\nv 1 0 0\rv 0 1 0").meshes[0].positions,
              ElementsAre(P{0, 0, 0}, P{1, 0, 0}, P{0, 1, 0}));
  // A corner that two faces share is one vertex.
  EXPECT_EQ(read_obj(kTriangle + "v 1 1 0\nf 1 2 4 3\nf 1 2 3\n").meshes[0].positions.size(), 4u);
}

TEST(ObjReader, FacesThatAreNoneAreNamed) {
  EXPECT_THAT(losses_of_obj(kMaterial + "f 1 2\nf 1\n"),
              ElementsAre("face of fewer than 3 corners, first in line 7 (2 times)"));
  EXPECT_THAT(losses_of_obj(kTriangle + "usemtl m\nf 1/1 2/2 3/3\n"),
              ElementsAre("texture coordinates (vt) that the file does not have, first in line 6"));
  EXPECT_THAT(losses_of_obj(kTriangle + "vn 0 0 1\nusemtl m\nf 1//1 2 3\n"),
              ElementsAre("normals (vn) at some corners of a face only, first in line 7"));
  EXPECT_EQ(refusal_of_obj(kTriangle + "f 1 2 4\n"), "line 4: the face has vertex \"4\", which the file does not have");
  EXPECT_EQ(refusal_of_obj(kTriangle + "f 1 2 0\n"), "line 4: \"0\" is no index: they are numbers from 1 or below 0");
  EXPECT_THAT(refusal_of_obj(kTriangle + "f 1 2 x\n"), HasSubstr("line 4: \"x\" is no index"));
  EXPECT_THAT(refusal_of_obj(kTriangle + "f 1/1/1/1 2 3\n"), HasSubstr("line 4: a corner of a face has up to three"));
  EXPECT_EQ(refusal_of_obj(kTriangle), "it has no triangles");
}

TEST(ObjReader, Utf16IsNamed) {
  const std::string utf16 = std::string("\xff\xfe") + "v" + '\0';
  EXPECT_EQ(refusal_of_obj(utf16), "it is UTF-16 text: save it as UTF-8");
  EXPECT_THAT(read_obj(kMaterial, utf16).warnings,
              ElementsAre("\"a.mtl\" is not read: it is UTF-16 text: save it as UTF-8"));
}

TEST(ObjReader, VerticesThatAreNoneAreErrors) {
  EXPECT_EQ(refusal_of_obj("v 0 0\n"), "line 1: \"v\" needs 3 numbers, it has 2");
  EXPECT_EQ(refusal_of_obj("v 0 0 0\nv 0 0 x\n"), "line 2: \"x\" is no number");
  EXPECT_EQ(refusal_of_obj("v 0 0 nan\n"), "line 1: \"nan\" is no number");
  EXPECT_EQ(refusal_of_obj("v 0 0 0 0\n"), "line 1: the weight of the vertex is 0");
}

TEST(ObjReader, StatementsThatAreNotReadAreNamed) {
  EXPECT_THAT(losses_of_obj("v 0 0 0 .1 .2 .3\nv 1 0 0 1 1 1\nv 0 1 0 0 0 0\nusemtl m\nf 1 2 3\n"),
              ElementsAre("vertex colours"));
  EXPECT_THAT(losses_of_obj("v 0 0 0 1 1 1\n" + kMaterial), IsEmpty());  // white
  EXPECT_THAT(losses_of_obj(kMaterial +
                            "l 1 2\np 1\np 2\ncstype bezier\ndeg 3\nparm u 0 1\ncurv 0 1 1 2\nsurf 0 1 0 1 1\nend\n"),
              ElementsAre("lines (l)", "points (p) (2 times)", "free-form curve (curv)", "free-form surface (surf)"));
  EXPECT_THAT(losses_of_obj(kMaterial + "usemap a\ncall b.obj\ntrace_obj c\nshadow_obj d\nxyz 1\nlod 3\n"),
              ElementsAre("texture map (usemap)", "file that another one includes (call)",
                          "reflected object (trace_obj)", "shadow object (shadow_obj)", "unknown statement \"xyz\""));
  EXPECT_THAT(losses_of_obj(kTriangle + "s 1\nusemtl m\nf 1 2 3\n"),
              ElementsAre("smoothing groups (s) without normals"));
}

TEST(ObjReader, MapCoordinatesAreSubtractedInDoublePrecision) {
  const std::string far =
      "v 500000.4375 5200000.75 312.25\n  v\t500000.5625 5200000.75 312.25 1 1 1\nv 500000.5625 5200001.125 312.25\n";
  const ImportedScene scene = read_obj(far + "f 1 2 3\n");
  EXPECT_EQ(scene.origin, (std::array<double, 3>{500001, 5200001, 312}));
  EXPECT_THAT(scene.meshes[0].positions,
              ElementsAre(P{-0.5625f, -0.25f, 0.25f}, P{-0.4375f, -0.25f, 0.25f}, P{-0.4375f, 0.125f, 0.25f}));
  EXPECT_EQ(read_obj(far + "v 0 0 0\nf 1 2 3\n").origin, (std::array<double, 3>{}));  // a quarter of them is near
  EXPECT_EQ(read_obj("v 1 2 3\nv 200 0 0\nv 0 9 0\nf 1 2 3\n").origin, (std::array<double, 3>{}));
}

/// A material file, those of a list, and MODEL.mtl in place of one that is missing.
TEST(ObjReader, MaterialFiles) {
  const auto color = [](const std::string& libraries, size_t warnings) {
    FilesInMemory files({{"a b.mtl", "newmtl m\nKd 1 0 0\n"},
                         {"c.mtl", "newmtl m\nKd 0 1 0\n"},
                         {"model.mtl", "newmtl m\nKd 0 0 1\n"}});
    const ImportedScene scene = read_obj(kMaterial + libraries, "model.obj", files);
    EXPECT_EQ(scene.warnings.size(), warnings);
    return scene.materials[0].color;
  };
  EXPECT_EQ(color("mtllib a b.mtl\n", 0), (P{1, 0, 0}));
  EXPECT_EQ(color("mtllib a b.mtl\nmtllib c.mtl\n", 0), (P{0, 1, 0}));
  EXPECT_EQ(color("mtllib c.mtl model.mtl\n", 0), (P{0, 0, 1}));
  EXPECT_EQ(color("mtllib missing.mtl\n", 1), (P{0, 0, 1}));
  EXPECT_EQ(color("mtllib missing.mtl model.mtl c.mtl\n", 1), (P{0, 1, 0}));
  EXPECT_THAT(losses_of_obj(kMaterial + "usemtl unused\n", "newmtl n\n"),
              ElementsAre("colour, which no material file states, of \"m\""));
  EXPECT_THAT(losses_of_obj(kMaterial, "newmtl m\nnewmtl n\nKs 1 1 1\n"), IsEmpty());
}

TEST(MtlReader, StatementsThatAreRead) {
  const ImportedScene scene =
      read_obj(kMaterial,
               "newmtl m\nKd .5\nTr .25\nMAP_KD -clamp on -colorspace sRGB -s 10 5 1 -o .1 .2 0 a b.png\nmap_d "
               "-imfchan m a.png\nnorm -bm 0.5 n.png\n"
               "illum 2\nKa 1 1 1\nNs 100\nNi 1.45\nKs 0 0 0\nKe 0 0 0\nTf 1 1 1\nPr 1\nPm 0\n");
  const ImportedMaterial& m = scene.materials[0];
  EXPECT_EQ(m.color, (P{1, 1, 1}));  // the image's
  EXPECT_EQ(m.opacity, 0.75f);
  EXPECT_EQ(scene.images[size_t(m.color_texture.image)].name, "a b.png");
  EXPECT_EQ(m.color_texture.wrap, ImportedTexture::Wrap::clamp);
  EXPECT_EQ(m.color_texture.to_image, (std::array<float, 6>{10, 0, 0.1f, 0, 5, 0.2f}));
  EXPECT_EQ(scene.images[size_t(m.opacity_texture.image)].name, "a.png");
  EXPECT_EQ(scene.images[size_t(m.normal_texture.image)].name, "n.png");
  EXPECT_EQ(m.normal_scale, (std::array<float, 2>{0.5f, 0.5f}));
  EXPECT_THAT(scene.losses, IsEmpty());
  EXPECT_EQ(read_obj(kMaterial, "newmtl m\nKd .5\n").materials[0].color, (P{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(read_obj(kMaterial, "newmtl m\nKe 2 0 1\n").materials[0].emission, (P{2, 0, 1}));
  EXPECT_EQ(read_obj(kMaterial, "newmtl m\nmap_Ke e.png\n").materials[0].emission, (P{1, 1, 1}));
}

TEST(MtlReader, TextureOptionsMoveTheCoordinates) {
  const ImportedScene scene = read_obj(kTriangle + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n",
                                       "newmtl m\nmap_Kd -s 2 4 -o 0.5 0.25 a.png\n");
  using Uv = std::array<float, 2>;
  EXPECT_THAT(scene.meshes[0].uvs, ElementsAre(Uv{0.5f, 0.25f}, Uv{2.5f, 0.25f}, Uv{0.5f, 4.25f}));
}

TEST(MtlReader, WhatIsNotReadIsNamed) {
  for (const auto& [statement, what] : std::map<std::string, std::string>{
           {"Ks 1 1 1", "gloss"},
           {"Tf 1 .5 1", "transmission filter (Tf)"},
           {"illum 4", "reflection or refraction (illum 4)"},
           {"Pr 0.3", "gloss"},
           {"Pm 1", "metalness (Pm)"},
           {"Ps 1", "sheen (Ps)"},
           {"Pc 1", "clear coat (Pc)"},
           {"aniso .5", "anisotropy (aniso)"},
           {"map_Bump -bm 2 b.png", "height map"},
           {"bump b.png", "height map"},
           {"disp b.png", "displacement map"},
           {"decal b.png", "decal"},
           {"refl -type sphere b.png", "reflection map (refl)"},
           {"map_Ns b.png", "map of gloss (map_Ns)"},
           {"map_Pr b.png", "roughness map"},
           {"d -halo 0.5", "opacity by direction (d -halo)"},
           {"d x", "opacity that is no number"},
           {"d .5\nTr .4", "the first of two opacities (d, Tr) that differ"},
           {"Kd spectral leaf.rfl 1", "colour that is not red, green and blue (Kd spectral)"},
           {"map_Kd -t 1 1 1 a.png", "map_Kd -t"},
           {"map_Kd -mm 0 2 a.png", "map_Kd -mm"},
           {"map_Kd -bm 2 a.png", "map_Kd -bm"},
           {"map_Kd -blendu off a.png", "map_Kd -blendu"},
           {"map_d -imfchan r a.png", "map_d -imfchan"},
           {"norm -clamp on n.png", "norm -clamp"},
           {"map_Kd", "map_Kd without a file"},
           {"shader x", "unknown statement \"shader\""},
       })
    EXPECT_THAT(losses_of_obj(kMaterial, "newmtl m\n" + statement + "\n"), ElementsAre(what + " of \"m\""))
        << statement;
  EXPECT_THAT(losses_of_obj(kMaterial, "Kd 1 1 1\nnewmtl m\n"), ElementsAre("statement before the first newmtl"));
}

TEST(Polygon, IsAFanIfItIsConvex) {
  EXPECT_THAT(triangulated({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), ElementsAre(T{0, 1, 2}));
  EXPECT_THAT(triangulated({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), ElementsAre(T{0, 1, 2}, T{0, 2, 3}));
}

/// Areas add up to that of the polygon, and none is turned over.
TEST(Polygon, ConcaveOnesAreCovered) {
  const std::vector<Vec3d> arrow{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
  const std::vector<Vec3d> comb{{0, 0, 1}, {5, 0, 1}, {5, 3, 1}, {4, 3, 1}, {4, 1, 1}, {3, 1, 1},
                                {3, 3, 1}, {2, 3, 1}, {2, 1, 1}, {1, 1, 1}, {1, 3, 1}, {0, 3, 1}};
  // A square with a hole, joined by an edge that is there twice.
  const std::vector<Vec3d> frame{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                                 {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  for (const auto& [polygon, area] : {std::pair(arrow, 1.5), std::pair(comb, 11.), std::pair(frame, 8.)}) {
    double sum = 0;
    for (const auto& [a, b, c] : triangulated(polygon)) {
      const double twice = cross(polygon[b] - polygon[a], polygon[c] - polygon[a]).z;
      EXPECT_GE(twice, 0);
      sum += twice / 2;
    }
    EXPECT_NEAR(sum, area, 1e-12);
    EXPECT_EQ(triangulated(polygon).size(), polygon.size() - 2);
  }
}

}  // namespace
}  // namespace frond
