#include <gmock/gmock.h>

#include <filesystem>
#include <iterator>

#include "tests/support/command_test.h"

/// Arguments and files that a command once accepted, although its output could not be read or content was omitted
/// without a message.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Hostile : public CommandTest {
 protected:
  /// Returns the message of a command that has to fail, and to write no file.
  std::string refusal(const Words& words, const std::string& output = "") const {
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 1) << o.err;
    EXPECT_FALSE(!output.empty() && std::filesystem::exists(path(output))) << output;
    return o.err;
  }
  std::string scene(const std::string& material) {
    return folder_
        .write("scene.pbrt",
               "Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2\nWorldBegin\n"
               "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n" +
                   material + "\nShape \"disk\"\n")
        .string();
  }
};

TEST_F(Hostile, CanopiesThatNoTableHoldsAreRefused) {
  const auto canopy = [this](const Words& words) {
    return refusal(joined({"canopy", "-o", path("c.npy"), "--count", "10"}, words), "c.npy");
  };
  for (const std::string option : {"--size=1e300,1e300", "--heights=-1e300,1e300", "--ball=1e300", "--scale=1e300",
                                   "--scale=1e-300", "--apart=1e-300"})
    EXPECT_THAT(canopy({option}), HasSubstr(option.substr(0, option.find('=')))) << option;
  EXPECT_THAT(canopy({"--column", "a=1:2", "--column", "a=3:4"}), HasSubstr("there are two columns \"a\""));
  EXPECT_THAT(canopy({"--column", "a=-1e308:1e308"}), HasSubstr("the largest of a table"));
  EXPECT_THAT(canopy({"--column", std::string(20000, 'a') + "=1:2"}), HasSubstr("10000 is the limit"));
}

/// Uses of a file by a scene, with FILE for its name.
const std::string kUses[] = {
    "Include \"FILE\"",
    "Import \"FILE\"",
    "Shape \"plymesh\" \"string filename\" \"FILE\"",
    "Material \"diffuse\" \"spectrum reflectance\" \"FILE\"",
    "Material \"leaf_simplified\" \"string tablefile\" \"FILE\"",
    "Material \"leaf_solved\" \"string tablefile\" \"FILE\"",
    "Material \"measured\" \"string filename\" \"FILE\"",
    "Material \"diffuse\" \"string normalmap\" \"FILE\"",
    "LightSource \"infinite\" \"string filename\" \"FILE\"",
    "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"FILE\"\nMaterial \"diffuse\" \"texture displacement\" "
    "\"t\"",
    "ObjectBegin \"o\"\nShape \"disk\"\nObjectEnd\nShape \"instances\" \"string object\" \"o\" \"string filename\" "
    "\"FILE\"",
    "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"FILE\"\nMediumInterface \"m\" \"\""};

/// Contents that the readers accept up to a word that no message may quote.
const std::string kSecrets[] = {
    "Xq7ThisIsSecret1 Xq7ThisIsSecret2\nXq7ThisIsSecret3\n",
    "Material \"Xq7ThisIsSecret\"\nShape \"Xq7ThisIsSecret\" \"float Xq7ThisIsSecret\" "
    "1\nXq7ThisIsSecret\nNamedMaterial "
    "\"Xq7ThisIsSecret\"\nMaterial \"diffuse\" \"Xq7ThisIsSecret reflectance\" 1\nRotate Xq7ThisIsSecret\n",
    "Option \"Xq7ThisIsSecret\" Xq7ThisIsSecret\nOption \"integer Xq7ThisIsSecret\" 5\nColorSpace \"Xq7ThisIsSecret\"\n"
    "Attribute \"Xq7ThisIsSecret\" \"float x\" 1\nAttribute \"shape\" \"float Xq7ThisIsSecret\" 1\n"
    "CoordSysTransform \"Xq7ThisIsSecret\"\nActiveTransform Xq7ThisIsSecret\nInclude \"Xq7ThisIsSecret\"\n"
    "Accelerator \"Xq7ThisIsSecret\"\nTexture \"Xq7ThisIsSecret\" \"Xq7ThisIsSecret\" \"Xq7ThisIsSecret\"\n",
    "LightSource \"Xq7ThisIsSecret\"\nAreaLightSource \"Xq7ThisIsSecret\"\nObjectInstance \"Xq7ThisIsSecret\"\n"
    "MediumInterface \"Xq7ThisIsSecret\" \"\"\nMakeNamedMedium \"Xq7ThisIsSecret\" \"string type\" "
    "\"Xq7ThisIsSecret\"\n"
    "Material \"diffuse\" \"spectrum reflectance\" \"Xq7ThisIsSecret\" \"texture Xq7ThisIsSecret\" "
    "\"Xq7ThisIsSecret\"\n"
    "Shape \"sphere\" \"texture alpha\" \"Xq7ThisIsSecret\"\nShape \"disk\" \"float radius\" Xq7ThisIsSecret\n",
    "Material \"diffuse\" \"texture reflectance\" \"Xq7ThisIsSecret\"\nShape \"plymesh\" \"string filename\" "
    "\"Xq7ThisIsSecret\"\nLightSource \"infinite\" \"string filename\" \"Xq7ThisIsSecret\"\n"
    "Material \"mix\" \"string materials\" [ \"Xq7ThisIsSecret\" \"Xq7ThisIsSecret\" ]\nShape \"sphere\"\n"
    "Material \"abm\" \"string specimen\" \"Xq7ThisIsSecret\"\nShape \"sphere\"\n",
    "MakeNamedMaterial \"Xq7ThisIsSecret\" \"string type\" \"diffuse\"\nNamedMaterial \"Xq7ThisIsSecretTwo\"\n"
    "Shape \"sphere\"\nNamedMaterial \"other\"\nShape \"sphere\"\nCoordinateSystem \"Xq7ThisIsSecret\"\n"
    "CoordSysTransform \"other\"\nObjectBegin \"Xq7ThisIsSecret\"\nObjectEnd\nObjectInstance \"other\"\n"
    "MakeNamedMedium \"Xq7ThisIsSecret\" \"string type\" \"homogeneous\"\nMediumInterface \"other\" \"\"\nShape "
    "\"sphere\"\n",
    "Texture \"Xq7ThisIsSecret\" \"spectrum\" \"constant\"\nMaterial \"diffuse\" \"texture reflectance\" \"other\"\n"
    "Shape \"sphere\"\nMakeNamedMaterial \"Xq7ThisIsSecret\" \"string type\" \"diffuse\"\n"
    "Material \"mix\" \"string materials\" [ \"other\" \"else\" ]\nShape \"sphere\"\n",
    "Translate Xq7ThisIsSecret 1 2\nMakeNamedMaterial \"Xq7ThisIsSecret\" \"string type\" \"Xq7ThisIsSecret\"\n",
    "ply\nformat ascii 1.0\nelement Xq7ThisIsSecret Xq7ThisIsSecret\n",
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty Xq7ThisIsSecret x\n",
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty float "
    "Xq7ThisIsSecret\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1 1 Xq7ThisIsSecret 1\n",
    "450 Xq7ThisIsSecret\n",
    "theta_deg,wavelength_nm,Rs,Rd,T\n0,450,Xq7ThisIsSecret,0,0\n",
    "theta_deg,wavelength_nm,Rs,Rd,Xq7ThisIsSecret\n",
    "wavelength_nm,R,T\n450,Xq7ThisIsSecret,0.1\n",
    "incidence_deg,wavelength_nm,theta_deg,phi_deg,f,kind\n0,450,10,0,Xq7ThisIsSecret,Xq7ThisIsSecret\n",
    "frond mode table Xq7ThisIsSecret\nXq7ThisIsSecret Xq7ThisIsSecret\n",
    std::string("\x93NUMPY\x01\0\x76\0", 10) +
        "{'descr': [('Xq7ThisIsSecret', '<f4'), ('b', '<f8')], 'fortran_order': False, 'shape': (1,), }" +
        std::string(64, ' ')};

TEST_F(Hostile, MessagesTellTheFirstEightCharactersOfWordsOfOtherPeoplesFiles) {
  folder_.write("scene/inside.txt", "");
  std::filesystem::create_symlink(path("secret"), path("scene/link"));
  size_t refused = 0;
  for (const std::string& use : kUses)
    for (const std::string& secret : kSecrets) {
      folder_.write("secret", secret);
      for (const std::string& name : {path("secret"), std::string("../secret"), std::string("link")}) {
        std::string world = use;
        for (size_t at; (at = world.find("FILE")) != world.npos;) world.replace(at, 4, name);
        const std::string scene = folder_.write("scene/s.pbrt", "WorldBegin\n" + world + "\nShape \"disk\"\n").string();
        const Outcome o = frond_command({"check", scene});
        refused += o.code == 1;
        EXPECT_THAT(o.out + o.err, Not(HasSubstr("Xq7ThisIs"))) << world << '\n' << secret;
      }
    }
  EXPECT_EQ(refused, 3 * std::size(kUses) * std::size(kSecrets));
}

TEST_F(Hostile, WordsOfTheScenesOwnFilesAreQuoted) {
  folder_.write("scene/sub/own.pbrt", "Material \"aMaterialOfMyOwn\"\nTranslate aNumberThatIsNone 1 2\n");
  const Outcome o =
      frond_command({"check", folder_.write("scene/s.pbrt", "WorldBegin\nInclude \"sub/own.pbrt\"\n").string()});
  EXPECT_THAT(o.err, AllOf(HasSubstr("own.pbrt:2:11: "), HasSubstr("aNumberThatIsNone")));
}

TEST_F(Hostile, AnIncludedFileThatIsNoSceneIsOneError) {
  folder_.write("key", "-----BEGIN PRIVATE KEY-----\neUK98iEG8IR3YvDzy012TccHIFEVmg\nE/IPb3LbAi0k0KltrUPBYXwamOeBK\n");
  const Outcome o =
      frond_command({"check", folder_.write("s.pbrt", "WorldBegin\nInclude \"key\"\nShape \"sphere\"\n").string()});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("key:1:1: this is no scene file: it begins with \"-----BEG...\""),
                           Not(HasSubstr("-----BEGI")), Not(HasSubstr("eUK98"))));
}

TEST_F(Hostile, ALineEndInANameIsEscaped) {
  const std::string scene = folder_
                                .write("s.pbrt",
                                       "WorldBegin\nNamedMaterial \"a\\nfrond: warning\"\nShape \"disk\"\n"
                                       "Material \"b\\n\\r\"\n")
                                .string();
  const Outcome o = frond_command({"check", scene});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err,
              AllOf(HasSubstr("\"a\\nfrond: warning\""), HasSubstr("\"b\\n\\r\""), Not(HasSubstr("\nfrond: warning"))));
}

TEST_F(Hostile, ErrorsOfParametersHaveAPlace) {
  for (const std::string world : {"LightSource \"sky\" \"float elevation\" 1e-6 \"float illuminance\" 1e38",
                                  "LightSource \"sky\" \"float scale\" 3e38",
                                  "LightSource \"distant\" \"float illuminance\" 3e38 \"float scale\" 3e38",
                                  "LightSource \"point\" \"float power\" 3e38 \"float scale\" 3e38"}) {
    const Outcome o =
        frond_command({"check", folder_.write("s.pbrt", "WorldBegin\n" + world + "\nShape \"sphere\"\n").string()});
    EXPECT_EQ(o.code, 1) << world;
    EXPECT_THAT(o.err, HasSubstr("s.pbrt:2:")) << world;
  }
}

TEST_F(Hostile, TimeLimitsThatEndAMeasurementAreToldOf) {
  const std::string leaf = scene("Material \"leaf_lambert\"");
  for (const std::string command : {"brf", "flux"})
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--paths", "4294967296"}, std::vector<std::string>{"--rms", "1e-300"}}) {
      std::vector<std::string> all{command,     leaf, "--target",     "-1,1,-1,1,1", "--wavelengths", "551",
                                   "--threads", "1",  "--time-limit", "1",           "--no-cache",    "-q"};
      all.insert(all.end(), words.begin(), words.end());
      if (command == "brf") all.insert(all.end(), {"--zenith", "0"});
      const Outcome o = frond_command(all);
      EXPECT_EQ(o.code, 0) << o.err;
      EXPECT_THAT(o.err, HasSubstr(words[0] == "--rms" ? "warning: --rms 1e-300 was not reached"
                                                       : "paths were traced, not 4294967296"))
          << command;
    }
}

TEST_F(Hostile, CheckReadsTables) {
  folder_.write("mutant.csv", "rubbish\n");
  for (const std::string model : {"leaf_simplified", "leaf_solved"}) {
    const auto checked = [&](const std::string& file) {
      return refusal({"check", scene("Material \"" + model + "\" \"string tablefile\" \"" + file + "\"")});
    };
    EXPECT_THAT(checked("mutant.csv"), HasSubstr("mutant.csv")) << model;
    EXPECT_THAT(checked("missing.csv"), AllOf(HasSubstr("scene.pbrt:5:"), HasSubstr("No such file"))) << model;
  }
}

TEST_F(Hostile, EveryReaderOfCsvNamesAFileWithoutRows) {
  for (const char* text : {"", "\n", "# a comment\n"}) {
    const std::string csv = folder_.write("none.csv", text).string();
    const std::string leaf = scene("Material \"diffuse\"");
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"fit", csv, "-o", path("fit.pbrt")},
             {"instances", csv, "-o", path("i.npy")},
             {"spectrophotometer", "diffuse,reflectance=" + csv, "--wavelengths", "500"},
             {"spectrophotometer", "leaf_simplified,tablefile=" + csv, "--wavelengths", "500"},
             {"brf", leaf, "--wavelengths", "bands,responses=" + csv}})
      EXPECT_THAT(refusal(words), HasSubstr("none.csv")) << words[0];
  }
}

TEST_F(Hostile, ATableOfNoInstancesIsRefused) {
  const std::string csv = folder_.write("none.csv", "x,y,z\n").string();
  EXPECT_THAT(refusal({"instances", csv, "-o", path("i.npy")}, "i.npy"),
              HasSubstr("none.csv:1:1: the file has no rows"));
}

TEST_F(Hostile, WhatIsFixedIsWhatAMaterialTakes) {
  for (const std::string fixed : {"thickness=1e30", "thickness=1e-320", "chlorophylla=1e308", "spongyaspect=1e300"})
    EXPECT_THAT(refusal({"fit", "--data", "wavelength,R,T\n550,0.1,0.1\n", "--like", "soybean", "--fix", fixed, "-o",
                         path("o.pbrt")},
                        "o.pbrt"),
                AllOf(HasSubstr("--fix " + fixed.substr(0, fixed.find('='))), HasSubstr("outside its range")));
}

TEST_F(Hostile, ExposuresBeyondAFloatAreRefused) {
  EXPECT_THAT(refusal({"convert", path("a.exr"), "--exposure", "2000", "-o", path("x.exr")}, "x.exr"),
              HasSubstr("--exposure"));
  EXPECT_THAT(refusal({"compare", scene("Material \"leaf_lambert\""), "--rms", "2"}), HasSubstr("--rms"));
}

TEST_F(Hostile, MessagesHaveNoControlCharacters) {
  const std::string said = refusal({"check", scene("Material \"\x1b[2J\x7f\" \"float \x1b[31m\" 1")});
  EXPECT_THAT(said, AllOf(HasSubstr("\\x1b[2J\\x7f"), Not(HasSubstr("\x1b"))));
  const auto file = folder_.write("d.csv", "wavelength,R,T\n550,a\x01z,0.1\n");
  EXPECT_THAT(refusal({"fit", file.string(), "--like", "soybean"}), HasSubstr("\"a\\x01z\" was given"));
}

}  // namespace
}  // namespace frond
