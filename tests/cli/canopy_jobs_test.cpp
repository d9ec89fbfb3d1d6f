#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command_test.h"

/// The jobs canopy and structure as commands; tests/scene and tests/radiometry test what they compute.
namespace frond {
namespace {

using ::testing::HasSubstr;

class CanopyJobs : public CommandTest {
 protected:
  Outcome canopy(std::vector<std::string> words) const {
    words.insert(words.begin(), {"canopy", "-o", folder_.name_of("leaves.npy")});
    return frond_command(words);
  }
  std::string error_of_file(const std::string& option, const std::string& text) const {
    const auto path = folder_.write("table.csv", text);
    std::string err = canopy({option, path.string()}).err;
    if (const size_t at = err.find(path.parent_path().string()); at != err.npos)
      err.erase(at, path.parent_path().string().size() + 1);
    return err;
  }
  Outcome structure(std::vector<std::string> words) const {
    const auto scene =
        folder_.write("scene.pbrt",
                      "Option \"float period\" [10 10]\nWorldBegin\n"
                      "LightSource \"distant\" \"point3 from\" [-1 0 1] \"point3 to\" [0 0 0]\n"
                      "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_solved\" NamedMaterial \"leaf\"\n"
                      "ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n"
                      "Shape \"instances\" \"string object\" \"leaf\" \"string filename\" \"leaves.npy\"\n");
    words.insert(words.begin(), {"structure", scene.string(), "--rays", "4096"});
    return frond_command(words);
  }
};

TEST_F(CanopyJobs, TheLogStatesTheAngles) {
  EXPECT_THAT(canopy({}).err, HasSubstr("leaf area index 3; leaf angles spherical, mean 57.30 degrees"));
  EXPECT_THAT(canopy({"--angles", "ellipsoidal,mean=57.29577951"}).err, HasSubstr("ellipsoidal, chi 1, mean 57.30"));
  EXPECT_THAT(canopy({"--angles", "ellipsoidal,chi=2"}).err, HasSubstr("ellipsoidal, chi 2, mean 38.48"));
  EXPECT_THAT(canopy({"--angles", "beta,mu=2.77,nu=1.17"}).err, HasSubstr("beta, mean 26.73 degrees"));
  const auto classes = folder_.write("classes.csv", "angle (deg);share\n15;1\n45;1\n75;2\n");
  EXPECT_THAT(canopy({"--angles", classes.string()}).err, HasSubstr("classes.csv, mean 52.50 degrees"));
  const auto points = folder_.write("points.csv", "0 1\n90 1\n");
  EXPECT_THAT(canopy({"--angles", points.string()}).err, HasSubstr("points.csv, mean 45.00 degrees"));
  // The classes of SCOPE: 10 degrees wide up to 80, then 2.
  const auto scope =
      folder_.write("scope.csv", "5,1\n15,1\n25,1\n35,1\n45,1\n55,1\n65,1\n75,1\n81,0\n83,0\n85,0\n87,0\n89,8\n");
  EXPECT_THAT(canopy({"--angles", scope.string()}).err, HasSubstr("scope.csv, mean 64.50 degrees"));
}

TEST_F(CanopyJobs, WrongAnglesAreExplained) {
  const auto error = [this](const std::string& angles) { return canopy({"--angles", angles}).err; };
  EXPECT_THAT(error("sferical"),
              HasSubstr("--angles: \"sferical\" is neither a file nor a distribution; did you mean \"spherical\"?"));
  EXPECT_THAT(error("spherical,chi=1"), HasSubstr("\"spherical\" has no parameters"));
  EXPECT_THAT(error("ellipsoidal"), HasSubstr("needs either mean, in degrees, or chi: ellipsoidal,mean=57.3"));
  EXPECT_THAT(error("ellipsoidal,mean=50,chi=1"), HasSubstr("needs either mean"));
  EXPECT_THAT(error("ellipsoidal,mean=95"),
              HasSubstr("\"mean\" of \"ellipsoidal\" is one number from 0 to 90, 95 was"));
  EXPECT_THAT(error("ellipsoidal,mean=89.9"), HasSubstr("lies between 0.904 and 89.6 degrees; 89.9 was given"));
  EXPECT_THAT(error("ellipsoidal,x=1"), HasSubstr("has no parameter \"x\""));
  EXPECT_THAT(error("beta,mu=2"), HasSubstr("needs mu and nu: beta,mu=2.77,nu=1.17"));
  EXPECT_THAT(error("missing.csv"), HasSubstr("missing.csv"));
  EXPECT_THAT(error_of_file("--angles", "0,1\n80,1\n"),
              HasSubstr("the angles run from 0 to 80: they are either points from 0 to 90 degrees"));
  EXPECT_THAT(error_of_file("--angles", "angle,share\n5,1\n15,-1\n"),
              HasSubstr("table.csv:3:4: the column frequency is below 0: -1"));
  EXPECT_THAT(error_of_file("--angles", "5\n15\n"), HasSubstr("two columns are needed, angle and frequency"));
  EXPECT_THAT(error_of_file("--angles", "0,0\n90,0\n"), HasSubstr("all frequencies are 0"));
}

TEST_F(CanopyJobs, AProfileStatesTheLeafAreaIndex) {
  const auto profile = folder_.write("profile.csv", "height (m),density (m2/m3)\n0.5,0\n1.5,2\n2.5,2\n3,0\n").string();
  EXPECT_THAT(canopy({"--profile", profile}).err, HasSubstr("leaf area index 3.5;"));
  EXPECT_THAT(canopy({"--profile", profile, "--lai", "2"}).err, HasSubstr("leaf area index 2;"));
  EXPECT_THAT(canopy({"--profile", profile, "--heights", "0,1"}).err, HasSubstr("--profile excludes --heights"));
  EXPECT_THAT(error_of_file("--profile", "1,1\n0.5,1\n"),
              HasSubstr("table.csv:2:1: the column height must ascend: 0.5 follows 1"));
  EXPECT_THAT(error_of_file("--profile", "1,x\n2,1\n"), HasSubstr("two rows are needed"));
  EXPECT_THAT(error_of_file("--profile", "1,0\n2,0\n"), HasSubstr("the leaf area density is 0 everywhere"));
  EXPECT_THAT(error_of_file("--profile", "1,1\n1e12,1\n"), HasSubstr("needs a number from -1e+09 to 1e+09"));
}

TEST_F(CanopyJobs, CrownsAndRowsAreChecked) {
  EXPECT_THAT(error_of_file("--crowns", "x,y,z,radius,form\n"), HasSubstr("table.csv:1:14: unknown column \"form\""));
  EXPECT_THAT(error_of_file("--crowns", "x,y,radius\n0,0,1\n"), HasSubstr("either z, of a crown's middle, or base"));
  EXPECT_THAT(error_of_file("--crowns", "x,y,z,rx\n0,0,1,1\n"), HasSubstr("radius is needed, or rx, ry and rz"));
  EXPECT_THAT(error_of_file("--crowns", "x,y,z,radius\n0,0,1,0\n"),
              HasSubstr("table.csv:2:7: the column radius is not"));
  EXPECT_THAT(error_of_file("--crowns", "x,y,base,radius,shape\n0,0,1,1,cube\n"), HasSubstr("unknown shape \"cube\""));
  EXPECT_THAT(error_of_file("--crowns", "x,y,z,radius\n"), HasSubstr("the file has no rows"));
  EXPECT_THAT(error_of_file("--crowns", "1,2,3,4\n"), HasSubstr("the first line names the columns: x, y, z, base"));
  EXPECT_THAT(canopy({"--rows", "1,2"}).err, HasSubstr("--rows: the width 2 is larger than the spacing 1"));
  EXPECT_THAT(canopy({"--rows", "11,2"}).err, HasSubstr("no row of spacing 11 fits"));
  EXPECT_THAT(canopy({"--rows", "0.75,0.5"}).err, HasSubstr("is no multiple of the spacing 0.75"));
}

TEST_F(CanopyJobs, TheStructureIsWrittenAsTables) {
  ASSERT_EQ(canopy({"--lai", "2", "--scale", "0.1"}).code, 0);
  const Outcome text = structure({"--zenith", "0,60"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, ::testing::ContainsRegex("leaf_area_index +1.9"));
  EXPECT_THAT(text.err, HasSubstr("sun at zenith angle 45, azimuth 180 degrees"));
  const std::string csv = folder_.name_of("s.csv");
  EXPECT_EQ(structure({"--zenith", "0,60", "--csv", csv, "--plot", folder_.name_of("s.svg"), "-q"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_.name_of("s-canopy.csv")));
  // The table of angles describes a canopy of equal angles.
  EXPECT_THAT(canopy({"--angles", folder_.name_of("s-angles.csv")}).err, HasSubstr("s-angles.csv, mean 57."));
  const auto json = nlohmann::json::parse(structure({"--json", "-", "-q"}).out);
  EXPECT_EQ(json["directions"].size(), 9u);
  EXPECT_EQ(json["directions"][0]["azimuth_deg"], "mean");
  EXPECT_NEAR(json["sun_zenith_deg"].get<double>(), 45, 1e-3);
  EXPECT_EQ(json["canopy"][0]["quantity"], "leaf_area_index");
}

TEST_F(CanopyJobs, TheStructureStopsAtAnError) {
  ASSERT_EQ(canopy({"--lai", "1", "--scale", "0.2"}).code, 0);
  const auto json = nlohmann::json::parse(structure({"--zenith", "30", "--rms", "0.002", "--json", "-", "-q"}).out);
  EXPECT_LE(json["error"].get<double>(), 0.002);
  EXPECT_GT(json["error"].get<double>(), 0.0007);
  EXPECT_THAT(structure({"--sun", "95,0"}).err, HasSubstr("--sun: the zenith angle 95 is not between 0 and 89.9"));
  const Outcome strict = structure({"--sun", "30,90", "--strict"});
  EXPECT_EQ(strict.code, 0) << strict.err;
  EXPECT_THAT(strict.err, HasSubstr("sun at zenith angle 30, azimuth 90 degrees"));
  EXPECT_THAT(structure({"--zenith", "90"}).err, HasSubstr("--zenith"));
  EXPECT_THAT(structure({"--csv", folder_.name_of("scene.pbrt")}).err, HasSubstr("would replace the input"));
}

TEST_F(CanopyJobs, CrownsInMapCoordinatesKeepTheirPositions) {
  const auto crowns = folder_.write("crowns.csv", "x,y,z,radius\n500000,4649776,5,2\n500300,4649776,5,2\n");
  const Outcome o = canopy({"--crowns", crowns.string(), "--count", "10"});
  EXPECT_THAT(o.err, HasSubstr("64-bit floats for positions far from the origin"));
  EXPECT_THAT(o.err, HasSubstr("--crowns: the crowns' centres extend over 300 x 0, the plot (--size) is 10 x 10"));
  EXPECT_THAT(canopy({"--crowns", crowns.string(), "--count", "10", "--size", "400,20"}).err,
              ::testing::Not(HasSubstr("the crowns' centres")));
}

TEST_F(CanopyJobs, TheStructureOfAMediumIsAnError) {
  const auto scene = folder_.write("medium.pbrt",
                                   "WorldBegin\nMakeNamedMedium \"leaves\" \"string type\" \"turbid\"\n"
                                   "MediumInterface \"leaves\" \"\" Material \"interface\" Shape \"sphere\"\n");
  EXPECT_THAT(frond_command({"structure", scene.string()}).err,
              HasSubstr("medium.pbrt:2:40: structure measures surfaces only, no participating media"));
}

}  // namespace
}  // namespace frond
