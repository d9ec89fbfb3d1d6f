#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/study/choose_scene.h"
#include "tests/support/command_test.h"

/// A leaf model of a shared object (examples/plugins/leaf_angular.cpp) is supported wherever built-in models are.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class LeafPlugin : public CommandTest {
 protected:
  static Outcome with_plugin(std::vector<std::string> arguments) {
    return frond_command(arguments, {"--plugin", FROND_TEST_PLUGINS "/leaf_angular.so"});
  }
  static nlohmann::json json_of(const Outcome& o) {
    EXPECT_EQ(o.code, 0) << o.err;
    return nlohmann::json::parse(o.out);
  }
  std::string scene() const { return folder_.write("scene.pbrt", two_leaves("", "", 32)).string(); }
};

TEST_F(LeafPlugin, IsAChoiceOfTheOpenLeaf) {
  EXPECT_THAT(with_plugin({"describe", "leaf"}).out,
              HasSubstr("auto | leaf_lambert | leaf_simplified | leaf_angular | leaf_solved | abm"));
  EXPECT_THAT(frond_command({"describe", "leaf"}).out, Not(HasSubstr("leaf_angular")));
  const auto measured = [](const std::string& material) {
    return json_of(
        with_plugin({"spectrophotometer", material, "--angles", "70", "--wavelengths", "550", "--json", "-"}));
  };
  EXPECT_EQ(measured("leaf,model=leaf_angular")["spectra"], measured("leaf_angular")["spectra"]);
}

TEST_F(LeafPlugin, ReplacesAllLeavesAndIsReplaced) {
  const std::string image = path("a.exr");
  EXPECT_EQ(with_plugin({"render", scene(), "--swap", "*=leaf_angular", "--spp", "1", "-o", image}).code, 0);
  const std::string own =
      folder_.write("own.pbrt", "WorldBegin\nMaterial \"leaf_angular\"\nShape \"sphere\"\n").string();
  EXPECT_EQ(with_plugin({"render", own, "--swap", "*=leaf_lambert", "--spp", "1", "-o", image}).code, 0);
}

TEST_F(LeafPlugin, IsComparedByDefault) {
  const auto j = json_of(with_plugin({"compare", scene(), "--quick", "--size", "16", "--spp", "4", "--reference-spp",
                                      "16", "--wavelengths", "smpte", "--rms", "0.05", "--json", "-"}));
  std::vector<std::string> labels;
  for (const auto& row : j["candidates"]) labels.push_back(row["candidate"]);
  EXPECT_THAT(labels,
              ::testing::IsSupersetOf({"abm", "leaf_solved", "leaf_angular", "leaf_simplified", "leaf_lambert"}));
}

TEST_F(LeafPlugin, IsSelected) {
  const auto choice = json_of(with_plugin({"render", scene(), "--wavelengths", "smpte", "--pilot", "--json", "-"}));
  std::vector<std::string> tried;
  for (const auto& option : choice["leaves"][0]["options"]) tried.push_back(option["name"]);
  EXPECT_THAT(tried, ::testing::ElementsAre("leaf_lambert", "leaf_simplified", "leaf_angular", "leaf_solved"));
}

TEST_F(LeafPlugin, IsComparedByBrf) {
  const std::string field = folder_
                                .write("field.pbrt", R"(
WorldBegin
LightSource "distant" "point3 from" [1 0 2] "point3 to" [0 0 0]
Material "leaf"
Shape "disk" "float radius" 10
)")
                                .string();
  const auto j = json_of(with_plugin({"brf", field, "--zenith", "0", "--wavelengths", "550", "--paths", "1024",
                                      "--target", "-1,1,-1,1,0", "--compare", "leaf_angular", "--json", "-"}));
  EXPECT_EQ(j["reference"], "leaf_solved");
}

TEST_F(LeafPlugin, IsWrittenByFit) {
  const std::string spectra = folder_
                                  .write("leaf.csv", R"(wavelength,R,T
450,0.05,0.01
550,0.12,0.12
650,0.06,0.03
700,0.15,0.2
800,0.46,0.46
900,0.46,0.47
1000,0.45,0.46
1200,0.42,0.44
1450,0.15,0.15
1650,0.32,0.34
1950,0.06,0.04
2200,0.19,0.2
)")
                                  .string();
  const std::string out = path("leaf.pbrt");
  const Outcome o = with_plugin({"fit", spectra, "--material", "leaf_angular", "-o", out});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(frond_command({"fit", spectra, "--material", "diffuse"}).err,
              AllOf(HasSubstr("\"diffuse\" is no leaf; leaves are leaf, leaf_lambert")));
}

}  // namespace
}  // namespace frond
