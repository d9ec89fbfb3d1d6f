#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "shapes/ply.h"
#include "system/file_bytes.h"
#include "tests/support/command_test.h"

/// The job flux by energy and by organ, as a command; tests/radiometry tests what it measures.
namespace frond {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class EnergyJob : public CommandTest {
 protected:
  /// A plane of leaf over a soil, under a sky, or under the light of `lights`.
  Outcome measured(Words words, const std::string& lights = "LightSource \"sky\" \"float elevation\" 40\n") {
    const auto scene = folder_.write(
        "scene.pbrt",
        "Option \"float period\" [1 1]\nWorldBegin\n" + lights +
            "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.2 2500 0.2]\n"
            "MakeNamedMaterial \"green\" \"string type\" \"leaf_lambert\" \"string specimen\" \"soybean\"\n"
            "NamedMaterial \"soil\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
            "NamedMaterial \"green\" Shape \"trianglemesh\" \"point3 P\" [0 0 1 0.5 0 1 0.5 1 1 0 1 1] "
            "\"integer indices\" [0 1 2 0 2 3]\n");
    words.insert(words.begin() + 1, {scene.string(), "--no-cache"});
    if (std::ranges::find(words, "--paths") == words.end()) words.insert(words.end(), {"--paths", "4096"});
    return frond_command(words);
  }
  std::string content(const std::string& name) const { return read_file_bytes(path(name), {}); }
};

TEST_F(EnergyJob, BandsGiveEnergyAlbedoAndFaparInAllOutputs) {
  const Outcome text = measured({"flux", "--bands", "all"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("fapar"));
  EXPECT_THAT(text.out, ContainsRegex("albedo +shortwave"));
  EXPECT_THAT(text.out, ContainsRegex("sunlit +0.5 +par"));
  EXPECT_EQ(measured({"flux", "--bands", "par,blue=400:500", "-q", "--csv", path("light.csv")}).code, 0);
  EXPECT_THAT(content("light.csv"),
              ContainsRegex("^quantity,material,band,first_nm,last_nm,share,share_se,direct_share,direct_share_se,"
                            "diffuse_share,diffuse_share_se,w_m2,w_m2_se,direct_w_m2,direct_w_m2_se,diffuse_w_m2,"
                            "diffuse_w_m2_se,umol_m2_s,umol_m2_s_se,direct_umol_m2_s,direct_umol_m2_s_se,"
                            "diffuse_umol_m2_s,diffuse_umol_m2_s_se\nincident,,par,400,700,1,0,1,0,1,0,"));
  EXPECT_THAT(content("light.csv"), HasSubstr("\nabsorbed,green,blue,400,500,"));
  EXPECT_THAT(content("light-leaves.csv"), ContainsRegex("\nshaded,[0-9.e-]+,[0-9.e-]+,.*,blue,400,500,"));
  const auto json = nlohmann::json::parse(measured({"flux", "--bands", "par", "--json", "-", "-q"}).out);
  EXPECT_NEAR(json["fapar"].get<double>(), 0.45, 0.05);
  EXPECT_GT(json["albedo_par"].get<double>(), 0.05);
  EXPECT_GT(json["albedo_par_se"].get<double>(), 0);
  EXPECT_EQ(json["irradiance"], "scene");
  EXPECT_EQ(json["energy"][0]["quantity"], "incident");
  EXPECT_EQ(json["leaves"].size(), 3u);
  EXPECT_NEAR(json["leaves"][1]["area"].get<double>(), 0.5, 0.01) << "the plane itself is in the sun";
}

TEST_F(EnergyJob, BandsAreNamedRanges) {
  EXPECT_THAT(measured({"flux", "--bands", "uv"}).err,
              HasSubstr("--bands: \"uv\" is none of par, nir and shortwave; NAME=FIRST:LAST gives a band in nm"));
  EXPECT_THAT(measured({"flux", "--bands", "a=500"}).err, HasSubstr("takes NAME=FIRST:LAST in nm"));
  EXPECT_THAT(measured({"flux", "--bands", "a b=500:600"}).err, HasSubstr("takes NAME=FIRST:LAST in nm"));
  EXPECT_THAT(measured({"flux", "--bands", "a=500:400"}).err, HasSubstr("a from 500 to 400 nm is not a range within"));
  EXPECT_THAT(measured({"flux", "--bands", "par,par"}).err, HasSubstr("two bands are named \"par\""));
  EXPECT_THAT(measured({"flux", "--bands", "par", "--wavelengths", "550"}).err, HasSubstr("--wavelengths"));
  EXPECT_THAT(measured({"brf", "--zenith", "0", "--wavelengths", "bands,ranges=400,700,700,1100,names=vis,nir"}).out,
              HasSubstr("band nir"));
  EXPECT_THAT(measured({"brf", "--zenith", "0", "--wavelengths", "bands,ranges=400,700,1100"}).err,
              HasSubstr("\"ranges\" takes pairs of wavelengths"));
}

TEST_F(EnergyJob, LightWithoutAUnitIsAWarning) {
  const std::string sun =
      "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" \"solar-am1.5-global\"\n";
  EXPECT_THAT(measured({"flux", "--bands", "all"}).err, Not(HasSubstr("has no unit")));
  EXPECT_THAT(measured({"flux", "--bands", "all"}, sun).err, HasSubstr("the light of the scene has no unit"));
  const Outcome g173 = measured({"flux", "--bands", "shortwave", "--irradiance", "solar-am1.5-global"}, sun);
  EXPECT_THAT(g173.err, Not(HasSubstr("has no unit")));
  EXPECT_THAT(g173.out, ContainsRegex("incident +shortwave +1 +992"));
}

TEST_F(EnergyJob, OrgansHaveRowsWithNamesAreasAndCentres) {
  EXPECT_EQ(measured({"flux", "--bands", "par", "--by", "mesh", "-q", "--csv", path("organs.csv")}).code, 0);
  EXPECT_THAT(content("organs.csv"),
              ContainsRegex("^mesh,name,material_name,instance,area,x,y,z,par_w_m2,par_w_m2_se,par_direct_w_m2,"
                            "par_direct_w_m2_se,par_umol_m2_s,par_umol_m2_s_se,par_incident_w_m2,par_incident_w_m2_se,"
                            "par_incident_umol_m2_s,par_incident_umol_m2_s_se,sunlit_share,sunlit_share_se\n1,soil,"
                            "soil,0,1,0.5,0.5,0,.*\n"
                            "2,green,green,0,0.5,0.25,0.5,1,"));
  EXPECT_THAT(content("organs-energy.csv"), HasSubstr("fapar"));
  EXPECT_THAT(content("organs-leaves.csv"), HasSubstr("sunlit"));
  EXPECT_THAT(measured({"flux", "--wavelengths", "550", "--by", "triangle", "-q"}).out,
              ContainsRegex("^triangle,name,material_name,instance,area,x,y,z,absorbed_550,absorbed_550_se\n1,soil,.*\n"
                            "2,green,.*\n3,green,"));
  EXPECT_THAT(measured({"flux", "--wavelengths", "550", "--by", "material", "-q"}).out,
              ContainsRegex("^material,name,material_name,area,x,y,z,absorbed_550,.*\n[0-9]+,soil,soil,1,.*\n"
                            "[0-9]+,green,green,0.5,"));
  EXPECT_THAT(measured({"flux", "--wavelengths", "550", "--by", "instance"}).err, HasSubstr("has no instances"));
}

TEST_F(EnergyJob, OrgansOfAPlantThatStandsAloneNeedItsSides) {
  const auto scene = folder_.write("alone.pbrt",
                                   "WorldBegin\nLightSource \"sky\"\nMaterial \"leaf_lambert\" \"string specimen\" "
                                   "\"soybean\" Shape \"trianglemesh\" \"point3 P\" [0 0 1 1 0 1 1 1 1]\n");
  const auto err = [&](const Words& more) {
    return frond_command({"flux", scene.string(), "--no-cache", "--by", "mesh", "--paths", "64", "-q"}, more).err;
  };
  EXPECT_THAT(err({"--bands", "par"}), HasSubstr("light that enters beside the scene's top does not count; --sides"));
  EXPECT_THAT(err({"--bands", "par", "--sides"}), Not(HasSubstr("beside the scene's top")));
  EXPECT_THAT(err({"--bands", "par", "--target", "0,1,0,1,1"}), Not(HasSubstr("beside the scene's top")));
  EXPECT_THAT(measured({"flux", "--sides"}).err, HasSubstr("a periodic scene has no sides"));
}

/// The property of a face is the light of its organ.
TEST_F(EnergyJob, APlyHasTheLightOfEachFace) {
  EXPECT_THAT(measured({"flux", "--bands", "par", "--ply", path("a.ply")}).err, HasSubstr("--ply needs --by"));
  const Outcome o =
      measured({"flux", "--bands", "par", "--by", "triangle", "--ply", path("a.ply"), "--csv", path("a.csv")});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("1 surfaces are left out"));  // the soil is a patch
  const std::string bytes = content("a.ply");
  EXPECT_THAT(bytes, HasSubstr("element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty "
                               "uchar green\nproperty uchar blue\nproperty float quality\nproperty float "
                               "par_w_m2\nproperty float par_umol_m2_s\nproperty float par_incident_w_m2\nproperty "
                               "float par_incident_umol_m2_s\n"
                               "property float sunlit_share\nproperty int triangle\nend_header\n"));
  EXPECT_THAT(bytes, HasSubstr("property uchar blue\nproperty float par_w_m2\n")) << "vertices, for Blender";
  const PlyMesh read = read_ply(path("a.ply"));
  ASSERT_EQ(read.mesh.triangles.size(), 2u);
  EXPECT_EQ(read.mesh.p[4].y, 1);
  // The last face ends with these and the number of its organ.
  struct {
    float quality, w, umol, incident_w, incident_umol, sunlit;
    int32_t organ;
  } last;
  std::memcpy(&last, bytes.data() + bytes.size() - sizeof last, sizeof last);
  EXPECT_EQ(last.organ, 3);
  EXPECT_EQ(last.quality, last.w);
  std::ifstream csv(path("a.csv"));
  std::string line, row;
  while (std::getline(csv, line)) row = line;
  std::vector<double> values;
  for (size_t begin = 0; begin < row.size();) {
    const size_t end = std::min(row.find(',', begin), row.size());
    values.push_back(std::atof(row.substr(begin, end - begin).c_str()));
    begin = end + 1;
  }
  EXPECT_NEAR(values[8], double(last.w), 1e-5 * values[8]);
  EXPECT_NEAR(values[12], double(last.umol), 1e-5 * values[12]);
  EXPECT_NEAR(values[14], double(last.incident_w), 1e-5 * values[14]);
  EXPECT_GT(last.incident_w, last.w);
  EXPECT_EQ(last.sunlit, 1);
}

}  // namespace
}  // namespace frond
