#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Numbers that are probably in another unit than the parameter's.
class UnitHints : public CommandTest {
 protected:
  /// Messages about a scene with a directive in line 2.
  Outcome check(const std::string& directive, bool is_strict = false) {
    const std::string scene =
        folder_.write("s.pbrt", "WorldBegin\n" + directive + "\nLightSource \"infinite\"\nShape \"disk\"\n").string();
    std::vector<std::string> words{"check", scene};
    if (is_strict) words.emplace_back("--strict");
    return frond_command(words);
  }
};

TEST_F(UnitHints, AreWarningsWithPlaceAndValue) {
  const auto warning = [this](const std::string& directive) {
    const Outcome done = check(directive);
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(check(directive, true).code, 1) << directive;
    return done.err;
  };
  EXPECT_THAT(
      warning("Texture \"e\" \"spectrum\" \"soil\" \"float moisture\" 0.25 Material \"diffuse\" \"texture "
              "reflectance\" \"e\""),
      HasSubstr("s.pbrt:2:48: warning: \"moisture\" is 0.25 % of the volume: if it is a fraction of 1, write 25"));
  EXPECT_THAT(warning("LightSource \"sky\" \"float pressure\" 1013"),
              HasSubstr("s.pbrt:2:36: warning: \"pressure\" is 1013 Pa: if it is in hPa (mbar), write 101300"));
  EXPECT_THAT(warning("LightSource \"sky\" \"float elevation\" 0.52"), HasSubstr("in radians, write 29.7938"));
  EXPECT_THAT(
      warning("Material \"leaf_solved\" \"float chlorophylla\" 40"),
      HasSubstr("\"chlorophylla\" is 40 kg/m^3: if it is in ug/cm2, divide it by thickness x mesophyllfraction"));
  // A map of fractions.
  EXPECT_THAT(
      warning("Texture \"m\" \"float\" \"checkerboard\" \"float tex1\" 0.1 \"float tex2\" 0.4 "
              "Texture \"e\" \"spectrum\" \"soil\" \"texture moisture\" \"m\" "
              "Material \"diffuse\" \"texture reflectance\" \"e\""),
      HasSubstr("texture \"m\" has values up to 0.4 % of the volume for \"moisture\": if it is a fraction of 1"));
}

TEST_F(UnitHints, AreInErrorsToo) {
  EXPECT_THAT(check("LightSource \"sky\" \"float ozone\" 310").err,
              HasSubstr("0 to 2 atm-cm; if it is in Dobson units, write 0.31"));
  EXPECT_THAT(check("Material \"leaf_solved\" \"float thickness\" 0.2").err,
              HasSubstr("; if it is in mm, write 0.0002"));
  EXPECT_THAT(check("Material \"leaf_solved\" \"float mesophyllfraction\" 50").err,
              HasSubstr("; if it is in percent, write 0.5"));
}

TEST_F(UnitHints, PlausibleNumbersAreSilent) {
  for (const char* directive : {"LightSource \"sky\" \"float elevation\" 1 \"float pressure\" 54000 \"float water\" 6",
                                "LightSource \"sky\" \"float elevation\" -0.5",
                                "Material \"leaf_solved\" \"float chlorophylla\" 9 \"float drymatter\" 0",
                                "Texture \"e\" \"spectrum\" \"soil\" \"float moisture\" 0"})
    EXPECT_THAT(check(directive).err, Not(HasSubstr("if it is"))) << directive;
}

TEST_F(UnitHints, OptionsHaveThemToo) {
  const auto said = [](const std::string& angles) {
    return frond_command({"spectrophotometer", "diffuse", "--wavelengths", "550", "--angles", angles}).err;
  };
  EXPECT_THAT(said("0.52"), HasSubstr("--angles: 0.52 degrees: if it is in radians, write 29.7938"));
  EXPECT_THAT(said("0,0.52,30"), Not(HasSubstr("radians")));
  EXPECT_THAT(
      frond_command({"fit", "--data", "wavelength,R,T\n550,0.1,0.1\n", "--like", "soybean", "--fix", "chlorophylla=40"})
          .err,
      HasSubstr("--fix chlorophylla: 40 kg/m^3: if it is in ug/cm2"));
}

}  // namespace
}  // namespace frond
