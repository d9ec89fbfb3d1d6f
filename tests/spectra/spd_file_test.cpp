#include "spectra/spd_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class SpdFile : public testing::Test {
 protected:
  SpdFile() : path_(std::filesystem::temp_directory_path() / fmt::format("frond_spd_{}.spd", getpid())) {}
  ~SpdFile() override { std::filesystem::remove(path_); }

  SpectrumPtr read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_spd(path_, {});
  }
  std::string error(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& e) {
      return std::string(e.what()).substr(path_.string().size());
    }
    return "no error";
  }

  std::filesystem::path path_;
};

TEST_F(SpdFile, ReadsPairsBetweenAnyWhiteSpaceAndComments) {
  const auto s = read("# lamp\n400 1.5e-1\n\t450 +0.25 # peak\r\n500\n.5");
  EXPECT_FLOAT_EQ(s->at(400), 0.15f);
  EXPECT_FLOAT_EQ(s->at(425), 0.2f);
  EXPECT_FLOAT_EQ(s->at(500), 0.5f);
}

TEST_F(SpdFile, ErrorsNameLineAndColumn) {
  EXPECT_EQ(error("400 1\n500  x2\n"),
            ":2:6: a spectrum file has a wavelength (nm) and a value in each line: this is not a number");
  EXPECT_EQ(error("400 1\n500 2e\n"),
            ":2:5: a spectrum file has a wavelength (nm) and a value in each line: this is not a number");
  EXPECT_EQ(error("400 1\n500 2\n600"), ":3:1: wavelength 600 nm has no value: the file ends after it");
  EXPECT_EQ(error("400 1\n  300 2\n"), ":2:3: wavelengths must ascend, 300 nm follows 400 nm");
  EXPECT_EQ(error("400 1\n500 nan\n"), ":2:1: the value at 500 nm is nan, finite numbers are needed");
  EXPECT_THAT(error("400 1"), EndsWith(":1:1: a spectrum needs two wavelengths at least, 1 given"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("holds no spectrum"));
}

TEST_F(SpdFile, ReadsTablesAsTheyArePublished) {
  for (const std::string text :
       {"wavelength,response\n600,1\n700,0.5\n", "600,1\n700,0.5\n",
        "\xef\xbb\xbf"
        "600 1\n700 0.5\n",
        "Wavelength (nm);Response\r\n600;1\r\n700;0,5\r\n", "600 1\n700 0,5\n", "response\tnm\n1\t600\n.5\t700\n",
        "\"\",\"wl\",\"x\"\n\"1\",600,1\n\"2\",700,.5\n", ",0\n600,1\n700,.5\n", "SR_WL,B1\n600,1\n700,.5 # end\n"}) {
    const auto s = read(text);
    EXPECT_EQ(s->at(600), 1) << text;
    EXPECT_EQ(s->at(700), 0.5f) << text;
  }
}

TEST_F(SpdFile, OneColumnOfSeveralIsSelected) {
  const std::string text = "SR_WL,S2A_SR_AV_B1,S2A_SR_AV_B2\n600,1,0\n650,1,0.5\n700,1,1\n";
  EXPECT_THAT(error(text), AllOf(HasSubstr(":1:1: there are 2 columns of values, \"S2A_SR_AV_B1\", \"S2A_SR_AV_B2\""),
                                 EndsWith(".spd:S2A_SR_AV_B1\"")));
  const auto of = [&](const std::string& column) { return read_spd_points(path_.string() + ":" + column, {}); };
  EXPECT_EQ(of("S2A_SR_AV_B2")[1].value, 0.5);
  EXPECT_EQ(of("s2a_sr_av_b1")[0].value, 1);
  EXPECT_THAT(error_of([&] { of("B3"); }), HasSubstr("there is no column \"B3\"; there are \"S2A_SR_AV_B1\""));
  EXPECT_THAT(error_of([] { parse_spd_points("400 1\n500 2\n", "a", "B1"); }), HasSubstr("no line that names"));
}

TEST_F(SpdFile, TablesThatAreNoSpectrumAreRefused) {
  EXPECT_THAT(error("400 1 2\n500 1 2\n"), HasSubstr(":1:1: each line has 3 numbers"));
  EXPECT_THAT(error("400,1,2\n500,1,2\n"), HasSubstr(":1:1: a line has a wavelength (nm) and a value, 3 numbers"));
  EXPECT_THAT(error("wl,a\n400,1\n500\n"), HasSubstr(":3:1: 1 fields, but the file has 2 columns"));
  EXPECT_THAT(error("wl,a\n"), HasSubstr("holds no spectrum"));
  EXPECT_THAT(error("wl,a\n0.4,1\n0.5,1\n"), HasSubstr("are these micrometres?"));
  EXPECT_THAT(error(",R\n1,.2\n2,.3\n"), HasSubstr("no column of wavelengths"));
}

/// A scene can name any file as a spectrum: messages do not quote the file's content.
TEST_F(SpdFile, MessagesDoNotQuoteOtherFiles) {
  for (const char* text : {"root:secret:1:0\nbin:secret:2\n", "a secret file\nof words\n", "secret,b,c\nd,e,f\n"})
    EXPECT_THAT(error(text), Not(HasSubstr("secret"))) << text;
}

TEST_F(SpdFile, UnreadableFilesAreNamedWhereTheSceneAsksForThem) {
  const Location here{std::make_shared<const std::string>("scene.pbrt"), 3, 7};
  for (const std::filesystem::path& path :
       {path_ / "missing.spd", std::filesystem::temp_directory_path(), std::filesystem::path("/dev/zero")})
    try {
      read_spd(path, here);
      ADD_FAILURE() << path;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr("scene.pbrt:3:7: cannot read spectrum file \"" + path.string()));
    }
}

}  // namespace
}  // namespace frond
