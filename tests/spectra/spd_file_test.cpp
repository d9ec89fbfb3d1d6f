#include "spectra/spd_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

namespace frond {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

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
            ":2:6: a spectrum file has two numbers in each line, with a blank between: this is not a number");
  EXPECT_EQ(error("400 1\n500 2e\n"),
            ":2:5: a spectrum file has two numbers in each line, with a blank between: this is not a number");
  EXPECT_EQ(error("400 1\n500 2\n600"), ":3:1: wavelength 600 nm has no value: the file ends after it");
  EXPECT_EQ(error("400 1\n  300 2\n"), ":2:3: wavelengths must ascend, 300 nm follows 400 nm");
  EXPECT_EQ(error("400 1\n500 nan\n"), ":2:1: the value at 500 nm is nan, finite numbers are needed");
  EXPECT_THAT(error("400 1"), EndsWith(":1:1: a spectrum needs two wavelengths at least, 1 given"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("holds no spectrum"));
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
