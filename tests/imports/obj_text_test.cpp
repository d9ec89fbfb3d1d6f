#include "imports/obj_text.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The text for the reader library, without the blank lines at its end.
std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

/// Reads an OBJ file, and a material file.
struct Read {
  explicit Read(const std::string& obj, const std::string& mtl = "", bool has_file = false) {
    model = trimmed(text.model(obj, [has_file](const std::string&) { return has_file; }));
    if (!mtl.empty()) materials = trimmed(text.materials(mtl));
    for (const ImportedLoss& loss : text.losses()) losses.push_back(text_of(loss));
  }
  ObjText text;
  std::string model, materials;
  std::vector<std::string> losses;
};

std::string refusal_of_obj(const std::string& obj) {
  try {
    Read read(obj);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no refusal";
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", kMaterial = kTriangle + "usemtl m\nf 1 2 3\n";

TEST(ObjText, StatementsThatAreReadStay) {
  const Read read("o a\n# x\n\nv 0 0 0 1\nv 1 0 0\nv 0 1,5 0 # y\nvt 1\nvn 0 0 1\ng b c\ns off\nf 1/1/1 2/1/1 3/1/1\n");
  EXPECT_EQ(read.model,
            "o a\nv 0 0 0 1\nv 1 0 0\nv 0 1,5 0\nvt 1 0\nvn 0 0 1\ng b c\nusemtl DefaultMaterial\nf 1/1/1 2/1/1 3/1/1");
  EXPECT_THAT(read.losses, IsEmpty());
}

/// The library reads 01 as two indices, and misplaces texture coordinates that only some corners have.
TEST(ObjText, FacesHaveOneForm) {
  const std::string head = kTriangle + "vt 0 0\nvn 0 0 1\nusemtl m\n";
  const auto face = [&head](const std::string& words) {
    const std::string text = Read(head + "f " + words + "\n").model;
    return text.substr(text.rfind("f "));
  };
  EXPECT_EQ(face("01 +2 3"), "f 1 2 3");
  EXPECT_EQ(face("-3/-1 -2/-1 -1/-1"), "f 1/1 2/1 3/1");
  EXPECT_EQ(face("1//1 2//1 3//1"), "f 1//1 2//1 3//1");
  EXPECT_EQ(face("1/1 2 3/1"), "f 1 2 3");
  EXPECT_EQ(Read(kTriangle + "usemtl m\nf 1 2 \\\n 3\n").model, kTriangle + "usemtl m\nf 1 2 3");
  EXPECT_EQ(Read("f 1 2 3\r\nv 0 0 0\r\nv 1 0 0\rv 0 1 0").model,
            "usemtl DefaultMaterial\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0");
}

TEST(ObjText, FacesThatAreNoneAreNamed) {
  EXPECT_THAT(Read(kMaterial + "f 1 2\nf 1\n", "newmtl m\n").losses,
              ElementsAre("face of fewer than 3 corners, first in line 6 (2 times)"));
  EXPECT_THAT(Read(kTriangle + "usemtl m\nf 1/1 2/2 3/3\n", "newmtl m\n").losses,
              ElementsAre("texture coordinates (vt) that the file does not have, first in line 5"));
  EXPECT_THAT(Read(kTriangle + "vn 0 0 1\nusemtl m\nf 1//1 2 3\n", "newmtl m\n").losses,
              ElementsAre("normals (vn) at some corners of a face only, first in line 6"));
  EXPECT_EQ(refusal_of_obj(kTriangle + "f 1 2 4\n"), "line 4: the face has vertex \"4\", which the file does not have");
  EXPECT_EQ(refusal_of_obj(kTriangle + "f 1 2 0\n"), "line 4: \"0\" is no index: they are numbers from 1 or below 0");
  EXPECT_THAT(refusal_of_obj(kTriangle + "f 1 2 x\n"), HasSubstr("line 4: \"x\" is no index"));
  EXPECT_THAT(refusal_of_obj(kTriangle + "f 1/1/1/1 2 3\n"), HasSubstr("line 4: a corner of a face has up to three"));
}

/// The library would drop such vertices, and shift the indices of all that follow.
TEST(ObjText, VerticesThatAreNoneAreErrors) {
  EXPECT_EQ(refusal_of_obj("v 0 0\n"), "line 1: \"v\" needs 3 numbers, it has 2");
  EXPECT_EQ(refusal_of_obj("v 0 0 0\nv 0 0 x\n"), "line 2: \"x\" is no number");
  EXPECT_EQ(refusal_of_obj("v 0 0 0 0\n"), "line 1: the weight of the vertex is 0");
  EXPECT_EQ(Read("v 1 2 3 0.1 0.2 0.3 1\nv 1 2 3 4 5\n").model, "v 1 2 3\nv 1 2 3");
}

TEST(ObjText, StatementsThatAreNotReadAreNamed) {
  EXPECT_THAT(Read("v 0 0 0 .1 .2 .3\nv 1 0 0 1 1 1\n").losses, ElementsAre("vertex colours"));
  EXPECT_THAT(Read("v 0 0 0 1 1 1\n").losses, IsEmpty());  // white
  EXPECT_THAT(Read("l 1 2\np 1\np 2\ncstype bezier\ndeg 3\nparm u 0 1\ncurv 0 1 1 2\nsurf 0 1 0 1 1\nend\n").losses,
              ElementsAre("lines (l)", "points (p) (2 times)", "free-form curve (curv)", "free-form surface (surf)"));
  EXPECT_THAT(Read("usemap a\ncall b.obj\ntrace_obj c\nshadow_obj d\nxyz 1\nlod 3\n").losses,
              ElementsAre("texture map (usemap)", "file that another one includes (call)",
                          "reflected object (trace_obj)", "shadow object (shadow_obj)", "unknown statement \"xyz\""));
  EXPECT_THAT(Read(kTriangle + "s 1\nusemtl m\nf 1 2 3\n", "newmtl m\n").losses,
              ElementsAre("smoothing groups (s) without normals"));
}

/// The library would give faces without a material the last one of the files.
TEST(ObjText, MaterialFilesComeFirst) {
  EXPECT_EQ(Read(kTriangle + "f 1 2 3\nmtllib a b.mtl\nusemtl m\nf 1 2 3\n").model,
            "mtllib a b.mtl\n" + kTriangle + "usemtl DefaultMaterial\nf 1 2 3\nusemtl m\nf 1 2 3");
  EXPECT_EQ(Read("mtllib a.mtl b.mtl\n", "", true).model, "mtllib a.mtl\nmtllib b.mtl");
}

TEST(ObjText, MaterialsThatNoFileHasAreNamed) {
  EXPECT_THAT(Read(kMaterial + "usemtl unused\n").losses,
              ElementsAre("colour, which no material file states, of \"m\""));
  EXPECT_THAT(Read(kMaterial, "newmtl m\nnewmtl n\nKs 1 1 1\n").losses, IsEmpty());
}

TEST(MtlStatements, StatementsThatAreReadStay) {
  const Read read(kMaterial,
                  "newmtl m\nKd .5\nTr .25\nMAP_KD -clamp on -s 1 1 a b.png\nmap_d -imfchan m a.png\nnorm -bm 1 n.png\n"
                  "illum 2\nKa 1 1 1\nNs 100\nNi 1.45\nKs 0 0 0\nKe 0 0 0\nTf 1 1 1\nPr 1\nPm 0\n");
  EXPECT_EQ(read.materials, "newmtl m\nKd .5 .5 .5\nTr .25\nmap_kd -clamp on a b.png\nmap_d a.png\nnorm n.png");
  EXPECT_THAT(read.losses, IsEmpty());
}

TEST(MtlStatements, WhatIsNotReadIsNamed) {
  const auto losses = [](const std::string& statement) {
    return Read(kMaterial, "newmtl m\n" + statement + "\n").losses;
  };
  const auto named = [](const std::string& what) { return ElementsAre(what + " of \"m\""); };
  for (const auto& [statement, what] : std::map<std::string, std::string>{
           {"Ks 1 1 1", "gloss"},
           {"Ke 0 1 0", "emission"},
           {"map_Ke e.png", "emission map"},
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
           {"map_Kd -o .1 a.png", "map_Kd -o"},
           {"map_Kd -s 10 5 1 a.png", "map_Kd -s"},
           {"map_Kd -t 1 1 1 a.png", "map_Kd -t"},
           {"map_Kd -mm 0 2 a.png", "map_Kd -mm"},
           {"map_Kd -blendu off a.png", "map_Kd -blendu"},
           {"map_d -imfchan r a.png", "map_d -imfchan"},
           {"norm -bm 0.5 n.png", "norm -bm"},
           {"map_Kd", "map_Kd without a file"},
           {"shader x", "unknown statement \"shader\""},
       })
    EXPECT_THAT(losses(statement), named(what)) << statement;
  EXPECT_THAT(Read(kMaterial, "Kd 1 1 1\nnewmtl m\n").losses, ElementsAre("statement before the first newmtl"));
}

}  // namespace
}  // namespace frond
