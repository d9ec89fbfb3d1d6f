#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "image/image_file.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Merge : public CommandTest {
 protected:
  void SetUp() override {
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    folder_.write("scene.pbrt", R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 20
Sampler "lattice" "integer pixelsamples" 37
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "thing" "string type" "diffuse" "rgb reflectance" [.2 .5 .1]
NamedMaterial "thing"
Shape "sphere" "float radius" .5
)");
  }
  void render(const Words& more) const {
    const Outcome o = frond_command({"render", path("scene.pbrt"), "--no-cache", "-q"}, more);
    ASSERT_EQ(o.code, 0) << o.err;
  }
  /// A part of some samples, and what else there is to say.
  std::string part(const std::string& samples, const Words& more = {}) const {
    const std::string file = path(fmt::format("{}.part", count_++));
    render(joined(more, {"--part", file, "--samples", samples}));
    return file;
  }
  static Outcome merge(const Words& files, const Words& more) { return frond_command(joined({"merge"}, files), more); }

  mutable int count_ = 0;
};

TEST_F(Merge, MakesTheFileOfTheSingleRun) {
  for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{
           {},
           {"--seed", "5", "--channels", "albedo,normal,depth,position,material,instance,samples"},
           {"--wavelengths", "bands,lambdamin=400,lambdamax=700,step=50", "--channels", "depth,samples"}}) {
    std::vector<std::string> single = how;
    single.insert(single.end(), {"-o", path("single.exr")});
    render(single);
    std::vector<std::string> left = how, right = how;
    left.insert(left.end(), {"--pixels", "0,9,0,20"});
    right.insert(right.end(), {"--pixels", "9,24,0,20"});
    const Outcome o = merge({part("16:37", left), part("0:37", right), part("5:16", left), part("0:5", left)},
                            {"-o", path("merged.exr"), "-q"});
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(bytes_of(path("merged.exr")), bytes_of(path("single.exr"))) << ::testing::PrintToString(how);
  }
}

TEST_F(Merge, RefusesWhatIsThereTwice) {
  const std::string a = part("0:10"), b = part("7:12");
  const Outcome o = merge({a, b}, {"-o", path("m.exr")});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr(a), HasSubstr(b), HasSubstr("samples 7:10"), HasSubstr("counts once")));
  EXPECT_FALSE(fs::exists(path("m.exr")));
  EXPECT_THAT(merge({a, a}, {"-o", path("m.exr")}).err, HasSubstr("samples 0:10"));
}

TEST_F(Merge, RefusesHolesUnlessTheyAreAllowed) {
  const std::string a = part("0:5"), b = part("16:37");
  const Outcome refused = merge({a, b}, {"-o", path("m.exr")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("samples 5:16"), HasSubstr("--allow-holes")));
  EXPECT_FALSE(fs::exists(path("m.exr")));
  const Outcome allowed = merge({a, b}, {"-o", path("m.exr"), "--allow-holes"});
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_THAT(allowed.err, HasSubstr("samples 5:16"));
  EXPECT_EQ(read_image(path("m.exr"), {}).header.text.at("frond:samples"), "26");
  // A part may have holes: the rest may still come.
  EXPECT_EQ(merge({a, b}, {"--part", path("both.part")}).code, 0);
  EXPECT_EQ(merge({path("both.part"), part("5:16")}, {"-o", path("whole.exr")}).code, 0);
  render({"-o", path("single.exr")});
  EXPECT_EQ(bytes_of(path("whole.exr")), bytes_of(path("single.exr")));
}

TEST_F(Merge, NamesWhatDiffers) {
  const std::string first = part("0:2");
  for (const auto& [more, field] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--seed", "2"}, "seed: "},
           {{"--wavelengths", "smpte"}, "wavelengths: "},
           {{"--integrator", "path,maxdepth=2"}, "integrator: "},
           {{"--channels", "depth"}, "channels: "},
           {{"--quick"}, "resolution: 24 x 20"},
           {{"--swap", "thing=diffusetransmission"}, ": "}}) {
    const std::string other = part("2:4", more);
    const Outcome o = merge({first, other}, {"-o", path("m.exr")});
    EXPECT_EQ(o.code, 1);
    EXPECT_THAT(o.err,
                AllOf(HasSubstr("not parts of the same render"), HasSubstr(field), HasSubstr(first), HasSubstr(other)));
  }
}

TEST_F(Merge, RefusesWhatIsNoPart) {
  EXPECT_THAT(merge({path("scene.pbrt")}, {"-o", path("m.exr")}).err, HasSubstr("is not a part file"));
  EXPECT_THAT(merge({path("none.part")}, {"-o", path("m.exr")}).err, HasSubstr("none.part"));
  EXPECT_THAT(merge({part("0:1")}, {}).err, HasSubstr("--output or --part is needed"));
}

}  // namespace
}  // namespace frond
