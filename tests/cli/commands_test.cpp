#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "image/image_file.h"
#include "jobs/record/command_line.h"
#include "jobs/record/common_params.h"
#include "render/plugins.h"
#include "scene/format/unsupported.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
namespace fs = std::filesystem;

class Commands : public CommandTest {
 protected:
  void SetUp() override {
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    folder_.write("scene.pbrt", R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "lattice" "integer pixelsamples" 4
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "thing" "string type" "diffuse" "rgb reflectance" [.2 .5 .1]
NamedMaterial "thing"
Shape "sphere" "float radius" .5
)");
  }
  Outcome render(const Words& more) const { return frond_command({"render", path("scene.pbrt"), "--no-cache"}, more); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path("."))) names.push_back(entry.path().filename().string());
    return names;
  }
};

TEST(IgnoreUnsupported, ItsDocNamesEveryKind) {
  for (const std::string_view kind : Unsupported::kinds())
    EXPECT_THAT(std::string(kIgnoreUnsupportedParam.doc), HasSubstr(std::string(kind)));
}

TEST_F(Commands, BadUseExitsWithOneAndAMessage) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"rendr"},
                                             {"render"},
                                             {"render", "--spp", "0", "x.pbrt"},
                                             {"render", "x.pbrt", "--nonsense"},
                                             {"render", "--threads", "-1", "x.pbrt"},
                                             {"render", "/no/such/scene.pbrt"},
                                             {"describe", "abn"},
                                             {"describe"}}) {
    const Outcome o = frond_command(arguments);
    EXPECT_EQ(o.code, 1) << ::testing::PrintToString(arguments);
    EXPECT_THAT(o.err, ::testing::Not(IsEmpty())) << ::testing::PrintToString(arguments);
  }
}

TEST_F(Commands, MistypedWordsAreNamedWithWhatMayBeMeant) {
  const auto complaint = [](const std::vector<std::string>& words) {
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 1);
    return o.err;
  };
  EXPECT_EQ(complaint({"rendr", "x.pbrt"}), "frond: there is no command \"rendr\"; did you mean \"render\"?\n");
  EXPECT_THAT(complaint({"paint"}), HasSubstr("there is no command \"paint\"; there are "));
  EXPECT_EQ(complaint({"--verson"}), "frond: frond has no option --verson; did you mean --version?\n");
  EXPECT_EQ(complaint({"render", "x.pbrt", "--sp", "1"}),
            "frond: frond render has no option --sp; did you mean --spp?\n");
  EXPECT_EQ(complaint({"render", "--sed=1"}), "frond: frond render has no option --sed; did you mean --seed?\n");
  // Where the word that is meant is required, that it is missing is only half of the truth.
  EXPECT_THAT(complaint({"table", "--wavelenghts", "551", "-o", "-"}), HasSubstr("did you mean --wavelengths?"));
  EXPECT_THAT(complaint({"render", "x.pbrt", "--nonsense"}), HasSubstr("frond render --help prints what it has"));
  EXPECT_EQ(complaint({"render", "x.pbrt", "y.pbrt"}), "frond: there is no file x.pbrt\n");
  EXPECT_THAT(complaint({}), HasSubstr("subcommand is required"));
  EXPECT_THAT(complaint({"describe", "foo"}), ::testing::Not(HasSubstr("did you mean")));
}

TEST_F(Commands, HelpAndVersionExitWithZero) {
  for (const char* flag : {"--help", "--version"}) EXPECT_EQ(frond_command({flag}).code, 0);
}

TEST_F(Commands, ListNamesEveryPluginAndDescribeItsParameters) {
  const Outcome list = frond_command({"list"});
  EXPECT_EQ(list.code, 0);
  for (const PluginInfo* info : all_plugins(builtin_registry())) {
    EXPECT_THAT(list.out, HasSubstr(std::string(info->name)));
    const Outcome describe = frond_command({"describe", std::string(info->name)});
    EXPECT_EQ(describe.code, 0);
    for (const Param& p : info->params) EXPECT_THAT(describe.out, HasSubstr(std::string(p.name)));
  }
  EXPECT_THAT(frond_command({"describe", "abn"}).err, HasSubstr("did you mean \"abm\"?"));
}

/// Of a leaf with parameters: of what PROSPECT's numbers describe the walk takes another one's place.
TEST_F(Commands, ALeafIsDescribedWithProspectsNumbers) {
  const std::string plates = "leaf_solved,N=1.5,Cab=40,Car=8,Cw=0.01,Cm=0.009";
  const Outcome of_plates = frond_command({"describe", plates});
  EXPECT_EQ(of_plates.code, 0) << of_plates.err;
  EXPECT_THAT(of_plates.out, AllOf(HasSubstr("parameters of the nearest walk, whose R and T differ by 0.0"),
                                   HasSubstr("chlorophylla"), HasSubstr("per leaf area"), HasSubstr("PROSPECT-D")));
  const Outcome of_walk = frond_command({"describe", "abm,specimen=walnut"});
  EXPECT_THAT(of_walk.out, AllOf(Not(HasSubstr("nearest walk")), HasSubstr("  Cab  ")));
  EXPECT_THAT(frond_command({"describe", "diffuse,reflectance=1"}).err, HasSubstr("\"diffuse\" is no leaf"));
  EXPECT_THAT(frond_command({"describe", "abm,N=1"}).err, HasSubstr("needs \"Cab\" too"));
  const auto measured = [](const std::string& leaf) {
    return frond_command({"spectrophotometer", leaf, "--wavelengths", "550,800", "--rays", "100"}).err;
  };
  const std::string difference = "leaf of PROSPECT: R and T of the walk differ by";
  EXPECT_THAT(measured(plates), HasSubstr(difference));
  EXPECT_THAT(measured("leaf_lambert" + plates.substr(plates.find(','))), Not(HasSubstr(difference)));
}

TEST_F(Commands, TheDocumentedPluginsAreThoseOfThisBuild) {
  const fs::path folder = path("pages"), docs = FROND_SOURCE_DIR "/docs";
  ASSERT_EQ(frond_command({"describe", "--pages", folder.string()}).code, 0);
  std::set<fs::path> written, documented;
  std::string all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    written.insert(entry.path().filename());
    all += bytes_of(entry.path());
    EXPECT_EQ(bytes_of(entry.path()), bytes_of(docs / entry.path().filename())) << "run: frond describe --pages docs";
  }
  for (const auto& entry : fs::directory_iterator(docs))
    if (entry.path().filename().string().starts_with("plugins")) documented.insert(entry.path().filename());
  EXPECT_EQ(written, documented);
  // Each plug-in is in one of the pages, at the link of the list of all plug-ins.
  for (const PluginInfo* info : all_plugins(builtin_registry())) {
    EXPECT_THAT(all, HasSubstr(fmt::format("## {} `{}`\n", info->kind, info->name)));
    EXPECT_THAT(all, HasSubstr(fmt::format("{} [`{}`](plugins_", info->kind, info->name)));
  }
  EXPECT_THAT(frond_command({"describe", "--pages", folder.string(), "abm"}).err, HasSubstr("leave out \"abm\""));
}

TEST_F(Commands, TheDocumentedCommandsAreThoseOfThisBuild) {
  EXPECT_EQ(frond_command({"describe", "--commands"}).out, bytes_of(FROND_SOURCE_DIR "/docs/commands.md"))
      << "run: frond describe --commands > docs/commands.md";
}

TEST_F(Commands, HelpManPageAndDescriptionHaveEveryParameter) {
  for (const JobInfo* job : all_jobs()) {
    const std::string name(job->name);
    const std::string texts[] = {frond_command({name, "--help"}).out, frond_command({"describe", name}).out};
    for (const std::string& text : texts)
      for (const JobParam* p : params_of(*job)) EXPECT_THAT(text, HasSubstr(std::string(p->name))) << name;
    EXPECT_THAT(texts[0], HasSubstr("Usage: " + usage(*job).substr(0, 12))) << name;
    EXPECT_THAT(frond_command({"--help"}).out, HasSubstr("\n  " + name + " ")) << name;
  }
}

TEST_F(Commands, HelpFitsInAHundredColumns) {
  for (const JobInfo* job : all_jobs()) {
    std::istringstream help(frond_command({std::string(job->name), "--help"}).out);
    for (std::string line; std::getline(help, line);) EXPECT_LE(line.size(), 100u) << line;
  }
  const std::string check = frond_command({"check", "--help"}).out;
  EXPECT_THAT(check, HasSubstr("Usage: frond check [OPTIONS] scene...\n"));
  EXPECT_THAT(check, HasSubstr("  --ignore-unsupported[=KINDS]\n                              Leave out"));
}

TEST_F(Commands, FluxWritesSharesAsTextCsvAndJson) {
  folder_.write("plate.pbrt", R"(
Option "float period" [ 1 1 ]
WorldBegin
LightSource "distant" "spectrum L" [300 1 2500 1] "point3 from" [ 0 0 2 ]
Material "diffuse" "spectrum reflectance" [300 .25 2500 .25]
Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0]
ObjectBegin "leaf" Shape "disk" "float radius" .1 ObjectEnd
Translate .5 .5 .1
ObjectInstance "leaf"
)");
  const auto flux = [&](std::vector<std::string> words) {
    const Outcome o =
        frond_command({"flux", path("plate.pbrt"), "--paths", "4096", "--wavelengths", "400:700:50", "-q"}, words);
    EXPECT_EQ(o.code, 0) << o.err;
    return o.out;
  };
  flux({"--csv", path("a.csv"), "--json", path("a.json")});
  const CsvTable table = parse_csv(bytes_of(path("a.csv")));
  EXPECT_EQ(table.names, (std::vector<std::string>{"quantity", "material", "wavelength_nm", "share", "share_se"}));
  EXPECT_EQ(table.text(7, "wavelength_nm"), "PAR");
  const auto json = nlohmann::json::parse(bytes_of(path("a.json")));
  EXPECT_EQ(json["paths"], 4096);
  EXPECT_NEAR(json["flux"][0]["share"].get<double>(), table.number(0, "share"), 1e-9);
  const CsvTable leaf = parse_csv(flux({"--by", "instance"}));  // the table goes to standard output, even with -q
  ASSERT_EQ(leaf.rows.size(), 1u);
  EXPECT_EQ(leaf.names[2], "par_umol_m2_s");
  EXPECT_NEAR(leaf.number(0, "absorbed_550"), 0.75 * 0.0314, 0.02);
}

TEST_F(Commands, RenderWritesWhatItSays) {
  const Outcome o =
      render({"-o", path("a.exr"), "--spp", "3", "--seed", "9", "--wavelengths", "smpte", "--json", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, IsEmpty());
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_EQ(json["samples_per_pixel"], 3);
  EXPECT_EQ(json["paths"], 26 * 18 * 3);  // samples of the pixels around reach into the image
  const ImageFile file = read_image(path("a.exr"), {});
  EXPECT_EQ(file.image.width, 24);
  EXPECT_EQ(file.image.height, 16);
  EXPECT_EQ(file.header.color_space, "linear SMPTE-C");
  EXPECT_EQ(file.header.text.at("frond:seed"), "9");
  EXPECT_EQ(file.header.text.at("frond:samples"), "3");
  EXPECT_EQ(file.header.text.at("frond:command"), "frond render scene.pbrt --wavelengths smpte --seed 9 --spp 3");
  EXPECT_EQ(file.header.text.at("frond:scene_hash").size(), 16u);
  ASSERT_TRUE(file.chromaticities);
  EXPECT_NEAR(file.chromaticities->red.x, 0.630, 1e-6);
  // The corners see the sky of radiance 1, the centre the sphere.
  EXPECT_NEAR(file.image.at(0, 0, *file.image.channel("G")), 1, 1e-5);
  EXPECT_LT(file.image.at(12, 8, *file.image.channel("R")), 0.6);
}

/// Channels that eleven bits cannot represent are stored as floats in a file of halves, too.
TEST_F(Commands, ChannelsOfWhatIsMetFirst) {
  std::ifstream in(path("scene.pbrt"));
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.replace(text.find("\"integer xresolution\""), 0, "\"bool savefp16\" true ");
  folder_.write("scene.pbrt", text);
  ASSERT_EQ(render({"-o", path("a.exr"), "--wavelengths", "smpte", "--spp", "64", "-q", "--channels",
                    "material,albedo,depth,samples,normal,position,instance"})
                .code,
            0);
  const ImageFile file = read_image(path("a.exr"), {});
  const auto at = [&](const char* channel) { return file.image.at(12, 8, file.image.channel(channel).value()); };
  // The sphere of radius 1/2 in the middle, seen from (0, 0, 2).
  EXPECT_NEAR(at("Z"), 1.5f, 0.01f);
  EXPECT_NEAR(at("P.Z"), 0.5f, 0.01f);
  EXPECT_NEAR(at("normal.Z"), 1, 0.02f);
  EXPECT_NEAR(at("albedo.G"), 0.5f, 0.02f);
  EXPECT_EQ(at("materialId"), 2);
  EXPECT_EQ(file.header.text.at("frond:material:2"), "thing");
  EXPECT_EQ(at("instanceId"), 0);
  EXPECT_EQ(at("samples"), 64);
  EXPECT_EQ(file.image.at(0, 0, file.image.channel("Z").value()), 0);
  const float z = at("Z");
  EXPECT_GT(std::abs(z * 4096 - std::round(z * 1024) * 4), 0) << "rounded to a half";
  EXPECT_THAT(render({"-o", path("b.exr"), "--channels", "albdo"}).err, HasSubstr("did you mean \"albedo\"?"));
}

TEST_F(Commands, TheSameFileOnAnyNumberOfThreads) {
  for (const char* threads : {"1", "2", "5"})
    ASSERT_EQ(render({"-o", path(std::string("t") + threads + ".exr"), "--threads", threads, "-q"}).code, 0);
  EXPECT_EQ(bytes_of(path("t1.exr")), bytes_of(path("t2.exr")));
  EXPECT_EQ(bytes_of(path("t1.exr")), bytes_of(path("t5.exr")));
  ASSERT_EQ(render({"-o", path("other.exr"), "--seed", "2", "-q"}).code, 0);
  EXPECT_NE(bytes_of(path("t1.exr")), bytes_of(path("other.exr")));
}

TEST_F(Commands, ACropIsAPartOfTheWhole) {
  ASSERT_EQ(render({"-o", path("whole.exr"), "-q"}).code, 0);
  ASSERT_EQ(render({"-o", path("part.exr"), "--pixels", "6,18,4,8", "-q"}).code, 0);
  const Image whole = read_image(path("whole.exr"), {}).image, part = read_image(path("part.exr"), {}).image;
  ASSERT_EQ(part.width, 12);
  ASSERT_EQ(part.height, 4);
  const size_t g = *whole.channel("G");
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 12; ++x) EXPECT_EQ(part.at(x, y, g), whole.at(x + 6, y + 4, g));
  ASSERT_EQ(render({"-o", path("fractions.exr"), "--crop", ".25,.75,.25,.5", "-q"}).code, 0);
  EXPECT_EQ(read_image(path("fractions.exr"), {}).image.pixels, part.pixels);
  ASSERT_EQ(render({"-o", path("corner.exr"), "--pixels", "0,1,0,1", "-q"}).code, 0);
  EXPECT_EQ(read_image(path("corner.exr"), {}).image.width, 1);
}

TEST_F(Commands, ACropThatIsNoneIsRefused) {
  for (const std::vector<std::string>& crop : std::vector<std::vector<std::string>>{{"--crop", "6,18,4,8"},
                                                                                    {"--crop", "0,.5,0"},
                                                                                    {"--crop", ".5,.5,0,1"},
                                                                                    {"--pixels", "5,5,0,1"},
                                                                                    {"--pixels", "0,.5,0,1"},
                                                                                    {"--pixels", "30,40,0,1"}})
    EXPECT_EQ(render({"-o", path("x.exr"), crop[0], crop[1]}).code, 1) << crop[1];
  EXPECT_THAT(render({"-o", path("x.exr"), "--pixels", "5,5,0,1"}).err, HasSubstr("--pixels 5,5,0,1 holds no pixel"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--pixel", "99,99"}).err, HasSubstr("film: x,y up to "));
}

TEST_F(Commands, WhatWouldHaveNoEffectIsRefused) {
  EXPECT_THAT(render({"-o", path("x.exr"), "--samples", "0:4", "--spp", "2"}).err,
              HasSubstr("--samples 0:4 ends above --spp 2"));
  EXPECT_EQ(render({"-o", path("x.exr"), "--samples", "0:2", "--spp", "2", "-q"}).code, 0);
  for (const auto& [name, value] : {std::pair{"--channels", "normal"}, {"--color-space", "ACEScg"}})
    EXPECT_THAT(render({"-o", path("x.png"), name, value}).err, HasSubstr(std::string(name) + " is for .exr: "));
  EXPECT_THAT(render({"-o", path("x.exr"), "--color-space", "foo"}).err, HasSubstr("\"foo\"; there are \"XYZ\", \""));
  EXPECT_THAT(render({"-o", path(std::string(300, 'x') + ".exr")}).err, HasSubstr("File name too long"));
}

TEST_F(Commands, WhatIsMeantIsAsked) {
  EXPECT_THAT(render({"-o", path("x.exr"), "--wavelengths", "700:400:10"}).err,
              HasSubstr("; a range ascends: 400:700:10"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--wavelengths", "0.45"}).err, HasSubstr("is this in micrometres?"));
  EXPECT_THAT(frond_command({"spectrophotometer", "abm", "--wavelengths", "0.45"}).err, HasSubstr("micrometres?"));
  EXPECT_THAT(frond_command({"spectrophotometer", "abm", "--wavelengths", "700:400:10"}).err, HasSubstr("400:700:10"));
  EXPECT_THAT(frond_command({"spectrophotometer", "abm"}).err,
              HasSubstr("--wavelengths is needed: Wavelengths, as in"));
  EXPECT_THAT(frond_command({"difference", "a", "b"}).err, HasSubstr("2 were given: A1 A2 B1 B2: two halves"));
  EXPECT_THAT(frond_command({"compare", path("scene.pbrt"), "-o", path("scene.pbrt")}).err,
              HasSubstr("--output would replace the input"));
  EXPECT_THAT(frond_command({"canopy", "-o", path("c.npy"), "--scale", "50"}).err,
              HasSubstr("a leaf has the area 7853.98 (--scale 50), the plot 100: no leaf fits"));
}

TEST_F(Commands, SpectraOfOtherWavelengthsAreErrors) {
  const auto error = [this](const std::string& reflectance) {
    folder_.write("s.pbrt", "WorldBegin LightSource \"infinite\"\nMaterial \"diffuse\" \"spectrum reflectance\" [" +
                                reflectance + "]\nShape \"disk\"");
    return frond_command({"render", path("s.pbrt"), "-o", path("x.exr"), "-q"}).err;
  };
  EXPECT_THAT(error("0.36 0.1 0.83 0.4"),
              HasSubstr("s.pbrt:2:44: the wavelengths are from 0.36 to 0.83: are these mic"));
  EXPECT_THAT(error("1000.4 0.1 2000 0.4"),
              HasSubstr("s.pbrt:2:44: \"reflectance\" is known from 1000.4 to 2000 nm alo"));
}

TEST_F(Commands, AnErrorIsNotFollowedByWarningsAboutTheWhole) {
  folder_.write("s.pbrt", "WorldBegin\nLightSorce \"infinite\"\nShape \"disk\"");
  EXPECT_THAT(frond_command({"check", path("s.pbrt")}).err, Not(HasSubstr("no light")));
}

TEST_F(Commands, AnInstanceIsNoMirrorImage) {
  folder_.write("i.csv", "x,y,z,scale\n0,0,0,1\n0,0,1,-2\n");
  EXPECT_THAT(frond_command({"instances", path("i.csv"), "-o", path("i.npy")}).err,
              HasSubstr("i.csv:3:7: the scale -2 is below 0"));
}

TEST_F(Commands, QuickIsSmallerAndCoarser) {
  const Outcome o = render({"-o", path("q.png"), "--quick", "--json", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(read_image(path("q.png"), {}).image.width, 12);
  EXPECT_EQ(nlohmann::json::parse(o.out)["samples_per_pixel"], 1);
}

TEST_F(Commands, SwapChangesTheModelByOneWord) {
  EXPECT_EQ(
      frond_command({"render", "-q", "--swap", "thing=diffusetransmission", path("scene.pbrt"), "-o", path("s.exr")})
          .code,
      0);
  const Outcome o = render({"-o", path("s.exr"), "--swap", "thing=diffusetransmission", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "*=abm"}).err,
              HasSubstr("none of the scene's materials is a leaf"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "thin=diffuse"}).err, HasSubstr("did you mean \"thing\"?"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "thing=difuse"}).err, HasSubstr("did you mean \"diffuse\"?"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "thing"}).err, HasSubstr("MATERIAL=PLUGIN"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "thing=diffusetransmission,scal=2"}).err,
              HasSubstr("did you mean \"scale\"?"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--swap", "thing=diffusetransmission,scale=-2"}).err,
              HasSubstr("frond: --swap thing=diffusetransmission,scale=-2: \"scale\" is -2, outside its range"));
}

TEST_F(Commands, WavelengthsTakeParameters) {
  EXPECT_EQ(render({"-o", path("w.exr"), "--wavelengths", "hero,lambdamin=500,lambdamax=600", "-q"}).code, 0);
  EXPECT_THAT(render({"-o", path("x.exr"), "--wavelengths", "hero,lambdamix=500"}).err,
              HasSubstr("did you mean \"lambdamin\"?"));
  EXPECT_THAT(render({"-o", path("x.exr"), "--wavelengths", "hero,lambdamax=2600"}).err,
              HasSubstr("outside its range"));
  // D65 has no data there, and there is no silent zero.
  EXPECT_THAT(render({"-o", path("x.exr"), "--wavelengths", "hero,lambdamax=1000"}).err,
              HasSubstr("scene.pbrt:7:37: \"L\" is known from 360 to 830 nm, the render needs 360 to 1000 nm"));
}

/// A band is a measurement; an image of colours is not, and is hardly affected by the ends of the visible range.
TEST_F(Commands, SpectraWithoutDataAreErrorsInBandsAndWarningsInColours) {
  const auto scene = [this](const std::string& option) {
    return folder_.write("soil.pbrt", option + R"(
Camera "orthographic"
Film "rgb" "integer xresolution" 2 "integer yresolution" 2
WorldBegin
LightSource "infinite"
Material "diffuse" "spectrum reflectance" [ 400 .1  2500 .5 ]
Shape "disk")");
  };
  const auto run = [&](const std::string& option, const std::string& command, const std::string& wavelengths) {
    std::vector<std::string> words{command, scene(option).string(), "-q", "--wavelengths", wavelengths};
    if (command == "render") words.insert(words.end(), {"-o", path("soil.exr"), "--no-cache", "--spp", "2"});
    if (command == "brf") words.insert(words.end(), {"--paths", "64"});
    return frond_command(words);
  };
  const std::string known = "\"reflectance\" is known from 400 to 2500 nm, the ";
  for (const auto& [command, wavelengths] :
       {std::pair("brf", "380,550"), {"flux", "380,550"}, {"render", "bands,wavelengths=380,550"}}) {
    const Outcome refused = run("", command, wavelengths);
    EXPECT_EQ(refused.code, 1) << command;
    EXPECT_THAT(refused.err,
                HasSubstr("soil.pbrt:6:45: " + known + "bands need 380 to 550 nm; Option \"bool extendspectra"));
    const Outcome extended = run("Option \"bool extendspectra\" true", command, wavelengths);
    EXPECT_EQ(extended.code, 0) << extended.err;
    EXPECT_THAT(extended.err, HasSubstr(known + "render needs 380 to 550 nm: beyond, its last value is taken"));
  }
  const Outcome seen = run("", "render", "hero,lambdamin=380");
  EXPECT_EQ(seen.code, 0);
  EXPECT_THAT(seen.err, HasSubstr(known + "render needs 380 to 830 nm: it is 0 beyond, as in pbrt-v4"));
}

/// From within a closed sphere that takes half of the light each time.
TEST_F(Commands, AnIntegratorOfTheScenesKindKeepsItsOtherParameters) {
  folder_.write("scene.pbrt", R"(
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "path" "integer maxdepth" 2
WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "sphere"
)");
  const auto ends = [&](const char* integrator) {
    const Outcome o = render({"-o", path("a.exr"), "--spp", "1", "--json", "-", "-q", "--integrator", integrator});
    return nlohmann::json::parse(o.out)["paths_absorbed_by_depth"].get<std::vector<int>>();
  };
  EXPECT_EQ(ends("path,termination=attenuation,cutoff=0.1"), (std::vector{0, 0, 16}));
  EXPECT_EQ(ends("path,termination=attenuation,cutoff=0.4"), (std::vector{0, 16}));
  EXPECT_EQ(ends("path,maxdepth=3,termination=attenuation"), (std::vector{0, 0, 0, 16}));
  EXPECT_EQ(read_image(path("a.exr"), {}).header.text.at("frond:command"),
            "frond render scene.pbrt --integrator path,maxdepth=3,termination=attenuation --spp 1");
  EXPECT_THAT(render({"-o", path("x.exr"), "--integrator", "path,cut=1"}).err, HasSubstr("has no parameter \"cut\""));
  EXPECT_THAT(render({"-o", path("x.exr"), "--integrator", "pat"}).err, HasSubstr("did you mean \"path\"?"));
}

/// After a second event three bands carry 0.27 in the mean; by the paper's weights of red, green and blue already the
/// first leaves 0.21 of the near infrared.
TEST_F(Commands, BandsAreCutOffByTheirMean) {
  folder_.write("scene.pbrt", R"(
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "path" "string termination" "attenuation" "float cutoff" .28
WorldBegin
LightSource "infinite" "spectrum L" [300 1 2500 1]
Material "diffuse" "spectrum reflectance" [300 .9 850 .9 1000 .03 2500 .03]
Shape "sphere"
)");
  const Outcome o = render(
      {"-o", path("a.exr"), "--spp", "1", "--json", "-", "-q", "--wavelengths", "bands,wavelengths=850,1650,2200"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(nlohmann::json::parse(o.out)["paths_absorbed_by_depth"].get<std::vector<int>>(), (std::vector{0, 16}));
}

TEST_F(Commands, AnImageSaysThroughWhichViewItWasMade) {
  ASSERT_EQ(render({"-o", path("a.png"), "--spp", "1", "-q", "--display", "sRGB"}).code, 0);
  EXPECT_EQ(read_image(path("a.png"), {}).header.text.at("frond:command"),
            "frond render scene.pbrt --spp 1 --display sRGB");
}

TEST_F(Commands, WhatCannotBeWrittenIsRefusedBeforeRendering) {
  const auto before = files();
  for (const std::string& output : {path("no/such/folder.exr"), path("image.xyz"), path(".")}) {
    const Outcome o = render({"-o", output, "--spp", "100000000"});  // would take days
    EXPECT_EQ(o.code, 1) << output;
    EXPECT_THAT(o.err, ::testing::Not(IsEmpty()));
  }
  EXPECT_EQ(render({"-o", path("a.png"), "--display", "no such display", "--spp", "100000000"}).code, 1);
  EXPECT_EQ(render({"-o", path("a.exr"), "--wavelengths", "rgb", "--spp", "100000000"}).code, 1);
  EXPECT_EQ(files(), before);
}

TEST_F(Commands, NoInputIsReplacedAndNoFileIsWrittenTwice) {
  const std::string scene = path("scene.pbrt"), table = path("table.csv");
  const auto text_of = [](const std::string& file) {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string before = text_of(scene);
  fs::create_symlink(scene, path("link.csv"));
  const Words brf{"brf", scene, "--no-cache", "--wavelengths", "550", "--paths", "64"};
  const auto refusal = [&](const Words& more) {
    const Outcome o = frond_command(brf, more);
    EXPECT_EQ(o.code, 1);
    return o.err;
  };
  EXPECT_THAT(refusal({"--csv", scene}), HasSubstr("--csv would replace the input \"" + scene));
  EXPECT_THAT(refusal({"--json", path("link.csv")}), HasSubstr("--json would replace the input"));
  EXPECT_THAT(refusal({"--csv", table, "--json", path("./table.csv")}),
              HasSubstr("--csv and --json write to the same file"));
  EXPECT_FALSE(fs::exists(table));
  EXPECT_THAT(render({"-o", scene}).err, HasSubstr("would replace the input"));
  ASSERT_EQ(render({"-o", path("in.exr"), "--spp", "1", "-q"}).code, 0);
  const std::string image = text_of(path("in.exr"));
  EXPECT_THAT(frond_command({"convert", path("in.exr"), "-o", path("in.exr")}).err,
              HasSubstr("would replace the input"));
  EXPECT_EQ(text_of(path("in.exr")), image);
  EXPECT_THAT(frond_command({"difference", path("in.exr"), path("in.exr"), path("in.exr"), path("in.exr")}).err,
              HasSubstr("A and B are the same images"));
  EXPECT_THAT(frond_command({"submit", scene, "-o", scene, "--spp", "2", "--tasks", "2", "--slurm"}).err,
              HasSubstr("would replace the input"));
  EXPECT_THAT(frond_command({"submit", scene, "-o", path("a.tif"), "--spp", "2", "--tasks", "2", "--slurm"}).err,
              HasSubstr("images are .exr, .png"));
  EXPECT_THAT(frond_command({"submit", "-", "-o", path("a.exr"), "--spp", "2", "--tasks", "2", "--slurm"}).err,
              HasSubstr("instead of standard input"));
  EXPECT_THAT(frond_command({"canopy", "--lai", "1", "--leaf-area", "0.01", "--size", "1,1", "-o", "-"}).err,
              HasSubstr("name a file"));
  EXPECT_EQ(text_of(scene), before);
}

TEST_F(Commands, SeveralScenesAreCheckedBeforeTheFirstIsRendered) {
  const auto scene = [this](const char* name, const char* film) {
    return folder_
        .write(name, fmt::format("Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \"string "
                                 "filename\" \"{}\"\nWorldBegin\nLightSource \"infinite\"\n",
                                 film))
        .string();
  };
  const fs::path before = fs::current_path();
  fs::current_path(fs::path(path("a")).parent_path());
  const std::string a = scene("a.pbrt", "one.exr"), b = scene("b.pbrt", "one.exr"), c = scene("c.pbrt", "two.exr");
  EXPECT_THAT(frond_command({"render", a, b, "--no-cache"}).err, HasSubstr("are both written to one.exr"));
  EXPECT_THAT(frond_command({"render", a, path("none.pbrt"), "--no-cache"}).err, HasSubstr("there is no file"));
  EXPECT_FALSE(fs::exists(path("one.exr")));
  const Outcome both = frond_command({"render", a, c, "--no-cache", "-q", "--json", "-"});
  fs::current_path(before);
  ASSERT_EQ(both.code, 0) << both.err;
  const auto json = nlohmann::json::parse(both.out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[1]["output"], "two.exr");
}

TEST_F(Commands, ContradictionsAreErrors) {
  const auto refusal = [this](const Words& more) {
    const Outcome o = render(joined(more, {"-o", path("x.exr"), "-q"}));
    EXPECT_EQ(o.code, 1);
    return o.err;
  };
  EXPECT_THAT(refusal({"--swap", "thing=diffuse", "--swap", "thing=diffuse"}), HasSubstr("replaces \"thing\" twice"));
  EXPECT_THAT(refusal({"--swap", "thing=leaf_lambert,specimen=maize,specimen=red"}), HasSubstr("is given twice"));
  EXPECT_THAT(refusal({"--integrator", "path,maxdepth=-1"}), HasSubstr("frond: --integrator: \"maxdepth\" is -1"));
  EXPECT_THAT(refusal({"--filter", "gauss"}), HasSubstr("frond: --filter: unknown pixel filter"));
  EXPECT_THAT(refusal({"--wavelengths", "smpte,red=455"}), HasSubstr("three different wavelengths"));
  EXPECT_FALSE(fs::exists(path("x.exr")));
}

TEST_F(Commands, HelpIsACommandToo) {
  EXPECT_EQ(frond_command({"help"}).out, frond_command({"--help"}).out);
  EXPECT_EQ(frond_command({"help", "flux"}).out, frond_command({"flux", "--help"}).out);
  EXPECT_THAT(frond_command({"render", "a.pbrt", "--spp"}).err, StartsWith("frond: --spp"));
}

/// A configuration that has linear sRGB, but no conversion to it from other spaces.
TEST_F(Commands, AnOpenColorIOConfigurationThatLacksTheFilmsSpaceIsRefusedBeforeRendering) {
  folder_.write("small.ocio", R"(ocio_profile_version: 2
roles: {default: linear sRGB}
displays:
  screen: [!<View> {name: plain, colorspace: linear sRGB}]
colorspaces:
  - !<ColorSpace> {name: linear sRGB}
)");
  setenv("OCIO", path("small.ocio").c_str(), 1);
  const Outcome hero = render({"-o", path("a.png"), "-q"}),
                smpte = render({"-o", path("b.png"), "--wavelengths", "smpte", "--spp", "100000000"});
  unsetenv("OCIO");
  EXPECT_EQ(hero.code, 0) << hero.err;
  EXPECT_EQ(smpte.code, 1);
  EXPECT_THAT(smpte.err, HasSubstr("aces_interchange"));
}

TEST_F(Commands, ErrorsInTheSceneNameTheirPlace) {
  folder_.write("bad.pbrt", "WorldBegin\nMaterial \"diffuse\" \"rgb reflectanc\" [1 1 1]\nShape \"sphere\"\n");
  const Outcome o = frond_command({"render", path("bad.pbrt"), "-o", path("bad.exr")});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(
      o.err,
      HasSubstr("bad.pbrt:2:20: material \"diffuse\" has no parameter \"reflectanc\"; did you mean \"reflectance\"?"));
  EXPECT_FALSE(fs::exists(path("bad.exr")));
}

TEST_F(Commands, DifferenceTellsNoiseFromBias) {
  for (const char* seed : {"1", "2"}) {
    ASSERT_EQ(render({"-o", path(std::string("a") + seed + ".exr"), "--seed", seed, "-q"}).code, 0);
    ASSERT_EQ(render({"-o", path(std::string("b") + seed + ".exr"), "--seed", std::string(seed) + "1", "-q"}).code, 0);
    ASSERT_EQ(render({"-o", path(std::string("c") + seed + ".exr"), "--seed", std::string(seed) + "2", "--swap",
                      "thing=diffusetransmission", "-q"})
                  .code,
              0);
  }
  const auto difference = [&](const char* a, const char* b) {
    const Outcome o = frond_command({"difference", path(a + std::string("1.exr")), path(a + std::string("2.exr")),
                                     path(b + std::string("1.exr")), path(b + std::string("2.exr")), "--json", "-",
                                     "-o", path("d.png")});
    EXPECT_EQ(o.code, 0) << o.err;
    return nlohmann::json::parse(o.out);
  };
  const auto same = difference("a", "b"), other = difference("a", "c");
  EXPECT_GT(same["rms_green"], 0);
  EXPECT_LT(same["bias_green"], same["noise_green"]);
  EXPECT_GT(other["bias_green"], other["noise_green"]);
  double squares = 0;
  for (const char* color : {"rms_red", "rms_green", "rms_blue"}) squares += std::pow(other[color].get<double>(), 2);
  EXPECT_NEAR(other["rms_all"].get<double>(), std::sqrt(squares / 3), 1e-9);
  EXPECT_GT(other["bias_squared_error_all"], other["bias_squared_error_green"].get<double>() / 3);
  EXPECT_EQ(read_image(path("d.png"), {}).image.width, 24);
}

TEST_F(Commands, DifferenceWarnsOfHalvesWithTheSameNoise) {
  for (const char* seed : {"1", "2"}) {
    ASSERT_EQ(render({"-o", path(std::string("a") + seed + ".exr"), "--seed", seed, "-q"}).code, 0);
    ASSERT_EQ(render({"-o", path(std::string("b") + seed + ".exr"), "--seed", seed, "--swap",
                      "thing=diffusetransmission", "-q"})
                  .code,
              0);
  }
  const auto warnings = [&](std::vector<std::string> images) {
    std::vector<std::string> words{"difference"};
    for (const std::string& image : images) words.push_back(path(image + ".exr"));
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 0) << o.err;
    return o.err;
  };
  EXPECT_THAT(warnings({"a1", "a1", "b1", "b2"}),
              HasSubstr("a1.exr have the same seed (1): noise cannot be told from bias; render one of them with"));
  EXPECT_THAT(warnings({"a1", "a2", "b2", "b2"}), HasSubstr("the same seed (2)"));
  EXPECT_THAT(warnings({"a1", "a2", "b2", "b1"}), HasSubstr("the same seed"));  // A1 with B2, A2 with B1
  EXPECT_THAT(warnings({"a1", "a2", "b1", "b2"}), IsEmpty());
}

TEST_F(Commands, ConvertAveragesAndShows) {
  for (const char* seed : {"1", "2"})
    ASSERT_EQ(render({"-o", path(std::string("a") + seed + ".exr"), "--seed", seed, "-q"}).code, 0);
  ASSERT_EQ(frond_command({"convert", path("a1.exr"), path("a2.exr"), "-o", path("mean.exr")}).code, 0);
  const Image a = read_image(path("a1.exr"), {}).image, b = read_image(path("a2.exr"), {}).image,
              mean = read_image(path("mean.exr"), {}).image;
  const size_t g = *a.channel("G"), m = *mean.channel("G");
  EXPECT_NEAR(mean.at(12, 8, m), (a.at(12, 8, g) + b.at(12, 8, g)) / 2, 1e-6);
  ASSERT_EQ(frond_command({"convert", path("mean.exr"), "-o", path("mean.png")}).code, 0);
  EXPECT_EQ(frond_command({"convert", path("mean.png"), "-o", path("again.png")}).code, 1);
}

/// Before the scene is built, which would fail here.
TEST_F(Commands, WhatTheOutputCannotHoldIsRefusedFirst) {
  folder_.write("scene.pbrt", R"(WorldBegin LightSource "infinite" "spectrum L" "no_such.spd")");
  const auto refusal = [&](std::vector<std::string> words) {
    const Outcome o = render(std::move(words));
    EXPECT_EQ(o.code, 1);
    return o.err;
  };
  EXPECT_THAT(refusal({"-o", path("x.png"), "--display", "foo"}), HasSubstr("unknown display \"foo\""));
  EXPECT_THAT(refusal({"-o", path("x.png"), "--view", "foo"}), HasSubstr("unknown view of display sRGB \"foo\""));
  EXPECT_THAT(refusal({"-o", path("x.png"), "--wavelengths", "bands,wavelengths=450,900"}),
              HasSubstr("cannot store bands"));
  EXPECT_THAT(refusal({"-o", path("x.exr"), "--view", "Raw"}), HasSubstr("holds linear values"));
  EXPECT_THAT(refusal({"-o", path("x.png")}), HasSubstr("no_such"));
}

TEST_F(Commands, ConvertRefusesADisplayForLinearValues) {
  ASSERT_EQ(render({"-o", path("a.exr"), "-q"}).code, 0);
  for (const char* option : {"--display", "--view"})
    EXPECT_THAT(frond_command({"convert", path("a.exr"), "-o", path("b.exr"), option, "sRGB"}).err,
                HasSubstr("b.exr holds linear values"));
  EXPECT_FALSE(fs::exists(path("b.exr")));
  EXPECT_THAT(frond_command({"convert", path("a.exr"), "-o", path("b.png"), "--view", "foo"}).err,
              HasSubstr("unknown view of display sRGB \"foo\""));
}

TEST_F(Commands, NumbersThatAreNoneAreRefused) {
  for (const std::vector<std::string>& option :
       std::vector<std::vector<std::string>>{{"--seed", "-1"},
                                             {"--seed", "99999999999999999999"},
                                             {"--seed", "1e30"},
                                             {"--spp", "1e30"},
                                             {"--spp", "-3"},
                                             {"--threads", "100000"}}) {
    EXPECT_EQ(render(joined({"-o", path("x.exr")}, option)).code, 1) << option[0] << option[1];
  }
  EXPECT_FALSE(fs::exists(path("x.exr")));
}

TEST_F(Commands, NumbersThatAreNoneAreToldInFewWords) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"difference", "a", "b", "c", "d", "--scale", "0"}, "--scale: a number above 0 is needed; \"0\" was given"},
      {{"spectrophotometer", "abm", "--wavelengths", "551", "--se", "0"}, "--se: a number above 0 is needed"},
      {{"spectrophotometer", "abm", "--wavelengths", "551", "--se", "nan"}, "--se: a number above 0 is needed"},
      {{"conform", "abm", "--false-alarm-rate", "1"}, "--false-alarm-rate: a number from 1e-12 to 0.5 is needed"},
      {{"convert", "a.exr", "-o", "b.png", "--exposure", "abc"},
       "--exposure: a number from -64 to 64 (stops) or auto is needed; \"abc\" was given"},
      {{"convert", "a.exr", "-o", "b.png", "--bands", "650,450"},
       "--bands takes three bands, as in 850,650,550 or nir,red,green; 2 were given"},
      {{"compare", "s.pbrt", "-o", "r", "--exposure", "99"},
       "--exposure: a number from -20 to 20 (stops) is needed; \"99\" was given"},
      {{"render", "s.pbrt", "--crop", "0,1,0,7"}, "--crop: 4 numbers from 0 to 1 with commas between are needed"},
      {{"render", "s.pbrt", "--pixels", "0,-4,0,1"}, "--pixels: 4 whole numbers from 0 to"},
      {{"render", "s.pbrt", "--spp", "0"}, "--spp: a whole number from 1 to"},
      {{"compare", "s.pbrt", "-o", "r", "--spp", "1.5"}, "--spp: a whole number from 1 to"}};
  for (const auto& [words, message] : cases) {
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 1) << message;
    EXPECT_THAT(o.err, HasSubstr(message));
  }
}

TEST_F(Commands, SamplesAreCountedAsRaysAre) {
  const Outcome o = render({"-o", path("a.exr"), "--spp", "1e1", "--json", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(nlohmann::json::parse(o.out)["samples_per_pixel"], 10);
}

TEST_F(Commands, AFilmLargerThanMemoryIsRefused) {
  folder_.write("vast.pbrt", "Film \"rgb\" \"integer xresolution\" 65536 \"integer yresolution\" 65536 WorldBegin");
  const Outcome o = frond_command({"render", path("vast.pbrt"), "-o", path("x.exr")});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("vast.pbrt:1:6: the film's 65536 x 65536 pixels need"));
  EXPECT_EQ(frond_command({"render", path("vast.pbrt"), "-o", path("x.exr"), "--pixels", "0,4,0,4", "--spp", "1"}).code,
            0);
}

TEST_F(Commands, PixelsTooBrightForTheFileHoldItsLargestNumber) {
  folder_.write("bright.pbrt", R"(
Film "rgb" "integer xresolution" 2 "integer yresolution" 2 "float iso" 1e38 "float exposuretime" 1e38
WorldBegin
LightSource "infinite"
)");
  const Outcome o = frond_command({"render", path("bright.pbrt"), "-o", path("b.exr"), "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  for (const float v : read_image(path("b.exr"), {}).image.pixels) EXPECT_TRUE(std::isfinite(v)) << v;
}

}  // namespace
}  // namespace frond
