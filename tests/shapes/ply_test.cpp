#include "shapes/ply.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/math/random.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

PlyMesh read(const std::string& text) { return read_ply_text(text, "m.ply"); }

/// Appends values to a binary body.
class Body {
 public:
  explicit Body(std::endian order) : swap_(order != std::endian::native) {}

  template <class T>
  Body& add(std::initializer_list<T> values) {
    for (const T value : values) {
      char raw[sizeof(T)];
      std::memcpy(raw, &value, sizeof(T));
      if (swap_) std::reverse(std::begin(raw), std::end(raw));
      bytes_.append(raw, sizeof(T));
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool swap_;
  std::string bytes_;
};

/// A quadrilateral and a triangle over five vertices, with every kind of thing to be read over.
std::string rich_header(std::string_view format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by hand\nobj_info nothing\n"
      "element material 1\nproperty list uchar short names\nproperty double shine\n"
      "element vertex 5\nproperty double x\nproperty float y\nproperty short z\nproperty uchar red\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
      "element face 2\nproperty int id\nproperty list uchar uint vertex_indices\nproperty list ushort float weights\n"
      "element edge 0\nproperty int a\nend_header\n",
      format);
}

std::string rich_ascii() {
  return rich_header("ascii") +
         "2 7 8 0.5\n"
         "0 0 0 255 0 0 1 0 0\n1 0 0 255 0 0 1 1 0\n1 1 0 255 0 0 1 1 1\n0 1 0 255 0 0 1 0 1\n0.5 2 -3 255 0 1 0 .5 2\n"
         "10 4 0 1 2 3 0\n11 3 3 2 4 2 .5 .25\n";
}

std::string rich_binary(std::endian order) {
  Body body(order);
  body.add<uint8_t>({2}).add<int16_t>({7, 8}).add<double>({0.5});
  const auto vertex = [&](double x, float y, int16_t z, std::initializer_list<float> rest) {
    body.add<double>({x}).add<float>({y}).add<int16_t>({z}).add<uint8_t>({255}).add<float>(rest);
  };
  vertex(0, 0, 0, {0, 0, 1, 0, 0});
  vertex(1, 0, 0, {0, 0, 1, 1, 0});
  vertex(1, 1, 0, {0, 0, 1, 1, 1});
  vertex(0, 1, 0, {0, 0, 1, 0, 1});
  vertex(0.5, 2, -3, {0, 1, 0, 0.5f, 2});
  body.add<int32_t>({10}).add<uint8_t>({4}).add<uint32_t>({0, 1, 2, 3}).add<uint16_t>({0});
  body.add<int32_t>({11}).add<uint8_t>({3}).add<uint32_t>({3, 2, 4}).add<uint16_t>({2}).add<float>({0.5f, 0.25f});
  return rich_header(order == std::endian::little ? "binary_little_endian" : "binary_big_endian") + body.bytes();
}

using Triangle = std::array<uint32_t, 3>;

TEST(Ply, ReadsTheSameMeshFromEveryFormat) {
  for (const auto& text : {rich_ascii(), rich_binary(std::endian::little), rich_binary(std::endian::big)}) {
    const PlyMesh file = read(text);
    const TriangleMesh& mesh = file.mesh;
    EXPECT_THAT(mesh.p, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}, Vec3{0.5f, 2, -3}));
    ASSERT_EQ(mesh.n.size(), 5u);
    EXPECT_EQ(mesh.n[4], (Vec3{0, 1, 0}));
    ASSERT_EQ(mesh.uv.size(), 5u);
    EXPECT_EQ(mesh.uv[4], (Vec2{0.5f, 2}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{3, 2, 4}));
    EXPECT_THAT(file.quads, ElementsAre(std::array<uint32_t, 4>{0, 1, 2, 3}));
  }
}

constexpr std::string_view kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_index\nend_header\n";  // 9 lines

std::string small(std::string_view body) { return std::string(kHeader) + std::string(body); }

TEST(Ply, LeavesNormalsAndTextureCoordinatesEmptyWhereThereAreNone) {
  const TriangleMesh mesh = read(small("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).mesh;
  EXPECT_TRUE(mesh.n.empty());
  EXPECT_TRUE(mesh.uv.empty());
}

TEST(Ply, KnowsTheNamesOfTextureCoordinates) {
  for (const auto& [u, v] : {std::pair("u", "v"), {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const PlyMesh mesh = read(fmt::format(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float {}\nproperty float {}\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 3 4\n3 0 0 0",
        u, v));
    EXPECT_THAT(mesh.mesh.uv, ElementsAre(Vec2{3, 4}));
  }
}

/// The second face, before its vertices, has other coordinates at vertex 1 and the same at vertex 2; of the third one
/// they are incomplete.
TEST(Ply, DividesVerticesWhoseCornersHaveSeveralTextureCoordinates) {
  const PlyMesh read_mesh = read(R"(ply
format ascii 1.0
element face 4
property list uchar float texcoord
property list uchar int vertex_indices
element vertex 4
property float x
property float y
property float z
end_header
6 0 0 1 0 0 1 3 0 1 2
6 0.5 0.5 0 1 1 1 3 1 2 3
2 7 7 3 0 2 3
8 0 0 1 0 1 1 0 1 4 0 1 3 2
0 0 0
1 0 0
0 1 0
1 1 0
)");
  const TriangleMesh& mesh = read_mesh.mesh;
  using T = std::array<uint32_t, 3>;
  EXPECT_THAT(mesh.triangles, ElementsAre(T{0, 1, 2}, T{4, 2, 3}, T{0, 5, 6}));
  EXPECT_THAT(read_mesh.quads, ElementsAre(std::array<uint32_t, 4>{0, 1, 3, 2}));
  EXPECT_THAT(mesh.uv,
              ElementsAre(Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}, Vec2{0.5f, 0.5f}, Vec2{0, 0}, Vec2{0, 0}));
  EXPECT_EQ(mesh.p.size(), mesh.uv.size());
  EXPECT_EQ(read_mesh.unused, "");
}

TEST(Ply, TakesWindowsLineEndsAndEmptyLines) {
  std::string text = small("0 0 0 \n\n1 0 0\n0 1 0\n3 0 1 2\n\n  \n");
  for (size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(read(text).mesh.triangles.size(), 1u);
}

TEST(Ply, ReadsFacesThatStandBeforeTheVertices) {
  EXPECT_EQ(read("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\n"
                 "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n")
                .mesh.triangles.size(),
            1u);
}

struct BadFile {
  std::string text, error;
};

void expect_errors(const std::vector<BadFile>& files) {
  for (const auto& [text, error] : files) EXPECT_EQ(error_of([&text = text] { read(text); }), "m.ply:" + error) << text;
}

/// The small file with the first `what` of its header replaced.
std::string with(std::string_view what, std::string_view replacement) {
  std::string text = small("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  return text.replace(text.find(what), what.size(), replacement);
}

TEST(Ply, RefusesHeadersThatAreNotWellFormed) {
  expect_errors({
      {"", "1:1: this is not a PLY file: it does not begin with a line \"ply\""},
      {"plyx\n", "1:1: this is not a PLY file: it does not begin with a line \"ply\""},
      {"ply\nformat ascii 1.0\n", "2:1: the header does not end: there is no end_header"},
      {with("format ascii 1.0\n", ""), "8:1: the header has no line \"format\""},
      {with("ascii", "asci"), "2:8: unknown format \"asci\"; did you mean \"ascii\"?"},
      {with("1.0", "2.0"), "2:14: version 2.0 of the format is not 1.0"},
      {with("ascii 1.0", "ascii"),
       "2:8: a header line of 3 words is needed: format, ascii or binary_little_endian or binary_big_endian, 1.0"},
      {with("element vertex", "elment vertex"), "3:1: unknown header keyword \"elment\"; did you mean \"element\"?"},
      {with("vertex 3", "vertex -3"), "3:16: \"-3\" is not a count"},
      {with("vertex 3", "vertex 99999999999999999999"), "3:16: \"99999999999999999999\" is not a count"},
      {with("vertex 3", "vertex"), "3:9: a header line of 3 words is needed: element, its name, its count"},
      {with("float x", "flot x"), "4:10: unknown type \"flot\"; did you mean \"float\"?"},
      {with("float x", "float x y"), "4:18: a header line of 3 words is needed: property, its type, its name"},
      {with("float y", "float x"), "5:1: property \"x\" is declared twice"},
      {with("float z", "list float int z"), "6:15: the length of a list is an integer, not float"},
      {with("list uchar int vertex_index", "list uchar vertex_index"),
       "8:21: a header line of 5 words is needed: property list, type of the length, type of the values, name"},
      {with("element face 1", "element vertex 1"), "7:1: element \"vertex\" is declared twice"},
      {with("element vertex 3\n", ""), "3:1: a property before any element"},
  });
}

TEST(Ply, RefusesHeadersThatDeclareNoMesh) {
  expect_errors({
      {with("vertex 3", "vertices 3"), "9:1: the header declares no element \"vertex\""},
      {with("face 1", "faces 1"), "9:1: the header declares no element \"face\""},
      {with("face 1", "face 0"), "7:1: the mesh has no faces"},
      {with("float z", "float w"), "3:1: element \"vertex\" needs properties x, y and z"},
      {with("float z", "list uchar float z"), "3:1: element \"vertex\" needs properties x, y and z"},
      {with("vertex_index", "indices"), "7:1: element \"face\" needs property \"vertex_indices\""},
      {with("uchar int", "uchar float"), "8:1: property \"vertex_index\" must be a list of integers"},
      {with("list uchar int", "int"), "8:1: property \"vertex_index\" must be a list of integers"},
      {with("element vertex", "element extra 1000000000\nelement vertex"), "3:1: element \"extra\" has no properties"},
      {with("vertex 3", "vertex 5000000000"), "3:1: 5000000000 vertices are more than indices can tell"},
  });
}

TEST(Ply, BelievesCountsOnlyAsFarAsTheFileGoes) {
  expect_errors({
      {with("vertex 3", "vertex 2000000000"),
       "3:1: element \"vertex\" has 2000000000 rows of at least 6 bytes, but 26 bytes are left in the file"},
      {with("face 1", "face 18446744073709551615"),
       "7:1: element \"face\" has 18446744073709551615 rows of at least 2 bytes, but 8 bytes are left in the file"},
  });
}

TEST(Ply, RefusesAsciiBodiesThatAreNotWellFormed) {
  expect_errors({
      {small("0 0 0\n1 0 0\n0 1 0 0\n3 0 1 2\n"),
       "12:7: vertex 2: the row has more values than the element has properties"},
      {small("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "11:4: vertex 1: the row ends too early"},
      {small("0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"), "11:5: vertex 1: a number is needed, x was given"},
      {small("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "11:3: vertex 1: a number is needed, nan was given"},
      {small("0 0 0\n1 1e39 0\n0 1 0\n3 0 1 2\n"), "11:3: vertex 1: y is inf"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "13:7: face 0: index 3 is out of range: there are 3 vertices"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), "13:7: face 0: index -1 is out of range: there are 3 vertices"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"), "13:7: face 0: index 1.5 is out of range: there are 3 vertices"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "13:6: face 0: the row ends too early"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1"), "13:6: face 0: the file ends too early"},
      {small("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
       "14:1: there is more data after the last element: a count in the header is wrong"},
  });
  const std::string list = with("element face 1", "element face 1\nproperty list int int more");
  expect_errors({
      {list.substr(0, list.size() - 8) + "-1 3 0 1 2\n",
       "14:1: face 0: \"more\" is a list of -1 values, which the file does not hold"},
      {list.substr(0, list.size() - 8) + "2000000000 3 0 1 2\n",
       "14:1: face 0: \"more\" is a list of 2000000000 values, which the file does not hold"},
  });
}

TEST(Ply, NamesTheByteWhereABinaryBodyIsWrong) {
  std::string header(kHeader);
  header.replace(header.find("ascii"), 5, "binary_little_endian");
  const auto file = [&](float y, std::initializer_list<int32_t> corners, uint8_t count) {
    Body body(std::endian::little);
    body.add<float>({0, 0, 0, 1, y, 0, 0, 1, 0}).add<uint8_t>({count}).add<int32_t>(corners);
    return header + body.bytes();
  };
  const auto error = [&](const std::string& text) { return error_of([&] { read(text); }); };
  const size_t start = header.size();
  const auto at = [&](size_t byte, std::string_view message) {
    return fmt::format("m.ply: byte {}: {}", start + byte, message);
  };
  EXPECT_EQ(error(file(0, {0, 1, 2}, 3)), "");
  EXPECT_EQ(error(file(NAN, {0, 1, 2}, 3)), at(16, "vertex 1: y is nan"));
  EXPECT_EQ(error(file(INFINITY, {0, 1, 2}, 3)), at(16, "vertex 1: y is inf"));
  EXPECT_EQ(error(file(0, {0, 3, 2}, 3)), at(41, "face 0: index 3 is out of range: there are 3 vertices"));
  EXPECT_EQ(error(file(0, {0, 1, 2}, 7)), at(37, "face 0: the file ends too early"));
  EXPECT_EQ(error(file(0, {0, 1}, 3)), at(45, "face 0: the file ends too early"));
  EXPECT_EQ(error(file(0, {0, 1, 2, 0}, 3)),
            at(49, "there is more data after the last element: a count in the header is wrong"));
  EXPECT_EQ(error(header),
            "m.ply:3:1: element \"vertex\" has 3 rows of at least 12 bytes, but 0 bytes are left in the file");
}

std::string with_header(std::string_view what, std::string_view replacement, std::string_view body) {
  std::string header(kHeader);
  return header.replace(header.find(what), what.size(), replacement) + std::string(body);
}

TEST(Ply, LeavesOutFacesOfOtherShapes) {
  const PlyMesh file =
      read(with_header("element face 1", "element face 3", "0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n5 0 1 2 0 1\n"));
  EXPECT_EQ(file.ignored, 2u);
  EXPECT_EQ(file.mesh.triangles.size(), 1u);
}

TEST(Ply, LeavesOutHalfAPairOfTextureCoordinatesAndASecondOne) {
  const std::string body = "0 0 0 5\n1 0 0 6\n0 1 0 7\n3 0 1 2\n";
  EXPECT_TRUE(read(with_header("float z\n", "float z\nproperty float u\n", body)).mesh.uv.empty());
  EXPECT_TRUE(read(with_header("float z\n", "float z\nproperty float nx\n", body)).mesh.n.empty());
  const PlyMesh file = read(with_header("float z\n", "float z\nproperty float u\nproperty float v\nproperty float s\n",
                                        "0 0 0 5 6 7\n1 0 0 6 7 8\n0 1 0 7 8 9\n3 0 1 2\n"));
  ASSERT_EQ(file.mesh.uv.size(), 3u);
  EXPECT_EQ(file.mesh.uv[1], (Vec2{6, 7}));
}

TEST(Ply, ReadsFilesAndNamesThoseItCannotRead) {
  const TestFolder folder("ply");
  EXPECT_EQ(read_ply(folder.write("a.ply", rich_ascii())).quads.size(), 1u);
  EXPECT_EQ(error_of([&] { read_ply(folder.name_of("gone.ply")); }), "there is no file " + folder.name_of("gone.ply"));
  EXPECT_THAT(error_of([&] { read_ply(folder.write("bad.ply", "solid")); }),
              StartsWith(folder.name_of("bad.ply:1:1: ")));
}

/// Reads or throws InputError; any other exception fails the test.
void read_anything(const std::string& text) {
  error_of([&] {
    const PlyMesh file = read(text);
    const TriangleMesh& mesh = file.mesh;
    for (const auto& q : file.quads)
      for (const uint32_t i : q) EXPECT_LT(i, mesh.p.size());
    for (const Triangle& t : mesh.triangles)
      for (const uint32_t i : t) EXPECT_LT(i, mesh.p.size());
  });
}

TEST(Ply, AFileCutShortAnywhereIsRefused) {
  for (const auto& text : {rich_ascii(), rich_binary(std::endian::little), rich_binary(std::endian::big)}) {
    const size_t trailing = text.back() == '\n' ? 1 : 0;  // the last line end may be missing
    for (size_t length = 0; length + trailing < text.size(); ++length) read_anything(text.substr(0, length));
    EXPECT_NE(error_of([&] { read(text.substr(0, text.size() - trailing - 4)); }), "");
  }
}

TEST(Ply, AFileWithAnyByteChangedIsReadOrRefused) {
  RandomStream rng(2);
  for (const auto& good : {rich_ascii(), rich_binary(std::endian::little), rich_binary(std::endian::big)})
    for (size_t i = 0; i < good.size(); ++i) {
      std::string text = good;
      for (const char c : {' ', '\n', '0', '9', '-', '\0', '\xff'}) text[i] = c, read_anything(text);
      for (int k = 0; k < 8; ++k) text[i] = static_cast<char>(rng.bits()), read_anything(text);
    }
}

/// A file as MeshLab writes it: texture coordinates of the corners of faces, colours of vertices, edges.
TEST(Ply, WhatIsNotUsedIsNamedWithItsCount) {
  const PlyMesh mesh = read(R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float u
property uchar red
element face 1
property list uchar int vertex_indices
property int face_indices
property list uchar float texcoord
property int texnumber
element edge 2
property int vertex1
end_header
0 0 0 0 255
1 0 0 0 255
0 1 0 0 255
3 0 1 2 7 6 0 0 1 0 0 1 0
0
1
)");
  EXPECT_EQ(mesh.mesh.triangles.size(), 1u);
  EXPECT_THAT(mesh.mesh.uv, ElementsAre(Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}));
  EXPECT_EQ(mesh.unused, R"("u", "red" of 3 vertices; "texnumber" of 1 faces; 2 rows of "edge")");
}

}  // namespace
}  // namespace frond
