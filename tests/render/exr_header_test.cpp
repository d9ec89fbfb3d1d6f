// Attributes of pbrt-v4's EXR files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "render/image_output.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

/// The 16 floats of a matrix in the header: its name, its type, its size, its numbers.
std::vector<float> matrix_in(const std::string& bytes, const std::string& name) {
  const std::string head = name + '\0' + "m44f" + '\0';
  const size_t at = bytes.find(head);
  if (at == std::string::npos) return {};
  std::vector<float> m(16);
  std::memcpy(m.data(), bytes.data() + at + head.size() + 4, 64);
  return m;
}

/// Matrices that pbrt-v4 (commit 5f7a6068) wrote for these cameras and the film of 64 x 64 pixels.
TEST(ExrHeader, HasTheMatricesOfPbrt) {
  const TestFolder folder("exr_header");
  const std::vector<float> view{-1, 0,         0,          0,        0, 0.235997f, 0.971754f, -0.874578f,
                                0,  0.971754f, -0.235997f, 7.41587f, 0, 0,         0,         1};
  const std::vector<float> ndc{-2.16574f, 0.485877f, -0.117999f, 3.70793f, 0, 0.996985f, 1.98657f,   1.81383f,
                               0,         0.971759f, -0.235998f, 7.41091f, 0, 0.971754f, -0.235997f, 7.41587f};
  const auto header = [&](const std::string& camera) {
    const auto file = folder.write("camera.pbrt", fmt::format(R"(
LookAt 0 -7 2.6  0 0 0.9  0 0 1
Camera {}
Film "rgb" "integer xresolution" 8 "integer yresolution" 4
WorldBegin
LightSource "infinite"
)",
                                                              camera));
    const RenderPart part = test::SceneRender{}.part(file, {0, 3});
    ImageOutput(folder.name_of("camera.exr"), {}).write(part.film, finished_format(part));
    std::ifstream in(folder.name_of("camera.exr"), std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const std::string perspective = header("\"perspective\" \"float fov\" 26");
  EXPECT_THAT(matrix_in(perspective, "worldToCamera"), ::testing::Pointwise(::testing::FloatNear(2e-5f), view));
  EXPECT_THAT(matrix_in(perspective, "worldToNDC"), ::testing::Pointwise(::testing::FloatNear(2e-5f), ndc));
  EXPECT_NE(perspective.find(std::string("samplesPerPixel\0int\0\4\0\0\0\3\0\0\0", 28)), std::string::npos);
  const std::string spherical = header("\"spherical\" \"string mapping\" \"equirectangular\"");
  EXPECT_THAT(matrix_in(spherical, "worldToCamera"), ::testing::SizeIs(16));
  EXPECT_THAT(matrix_in(spherical, "worldToNDC"), ::testing::IsEmpty());
}

}  // namespace
}  // namespace frond
