#include <gmock/gmock.h>

#include "jobs/record/job.h"
#include "render/material_words.h"
#include "tests/cli/command.h"
#include "tests/cli/table.h"
#include "tests/support/input_error.h"

/// One grammar for a material in text: the old form, with blanks, gives the same random numbers and a note.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MaterialText, OldFormsAreOneWord) {
  const Log& log = silent_log();
  EXPECT_EQ(material_text({"abm,specimen=maize"}, log), "abm,specimen=maize");
  EXPECT_EQ(material_text({"abm", "specimen=maize", "thickness=1e-4"}, log), "abm,specimen=maize,thickness=1e-4");
  EXPECT_EQ(material_text({"abm  specimen=maize thickness=1e-4"}, log), "abm,specimen=maize,thickness=1e-4");
  EXPECT_THAT(error_of([&] { material_text({"abm", "thickness"}, log); }), HasSubstr("looks like name=value"));
  EXPECT_THAT(error_of([&] {
                material_text({"abm,specimen=maize", "leaf,specimen=red"}, log);
              }),
              HasSubstr("looks like name=value: \"leaf,specimen=red\""));
  EXPECT_THAT(error_of([&] { material_text({""}, log); }), HasSubstr("a material is needed"));
  EXPECT_EQ(material_text({"diffuse", "reflectance=one half.spd"}, log), "diffuse,reflectance=one half.spd");
  EXPECT_EQ(material_text({"diffuse reflectance=one half.spd"}, log), "diffuse,reflectance=one half.spd");
  EXPECT_EQ(material_text({"diffuse,reflectance=a b=c.spd"}, log), "diffuse,reflectance=a b=c.spd");
}

TEST(MaterialText, BothFormsHaveTheSameSeed) {
  EXPECT_EQ(material_seed("mix,materials=abm,diffuse,amount=0.2"), hash_bytes("mix materials=abm,diffuse amount=0.2"));
  EXPECT_EQ(material_seed("abm"), hash_bytes("abm"));
}

class OldForm : public ::testing::TestWithParam<const char*> {
 protected:
  static Outcome measured(std::vector<std::string> words) {
    words.insert(words.begin(), GetParam());
    words.insert(words.end(), {"--no-cache", "--wavelengths", "551", "--rays", "1e3", "--csv", "-"});
    return frond_command(words);
  }
};

TEST_P(OldForm, GivesTheSameBytesAndANote) {
  const Outcome now = measured({"abm,specimen=maize", "--with", "mix,materials=abm,diffuse"}),
                old = measured({"abm", "specimen=maize", "--with", "mix materials=abm,diffuse"});
  EXPECT_EQ(now.code, 0) << now.err;
  EXPECT_EQ(now.out, old.out);
  EXPECT_THAT(now.err, IsEmpty());
  EXPECT_THAT(old.err, AllOf(HasSubstr("as one word, abm,specimen=maize;"), HasSubstr("mix,materials=abm,diffuse;")));
}

INSTANTIATE_TEST_SUITE_P(Instruments, OldForm, ::testing::Values("spectrophotometer", "goniophotometer"));

/// Figures of the program before materials were one text.
TEST(OldFormFigures, AreThoseOfEarlierVersions) {
  const Outcome o = frond_command({"spectrophotometer", "abm,specimen=maize", "--no-cache", "--wavelengths", "551",
                                   "--rays", "1e4", "--seed", "7", "--csv", "-"});
  EXPECT_EQ(parse_csv(o.out).text(0, "R"), "0.1123");
}

TEST(MeasureJobs, RefuseWithTheSameWordsInBothFrontEnds) {
  struct {
    std::string job, name, value;
  } const kCases[] = {{"spectrophotometer", "angles", "181"},
                      {"spectrophotometer", "wavelengths", "300"},
                      {"spectrophotometer", "rays", "1"},
                      {"spectrophotometer", "se", "0"},
                      {"goniophotometer", "map-scale", "square"},
                      {"goniophotometer", "rays", "0.5"},
                      {"conform", "false-alarm-rate", "0.6"},
                      {"conform", "angles", "90"},
                      {"bench", "lanes", "5"},
                      {"bench", "min-time", "nan"},
                      {"export", "view-azimuths", "360"},
                      {"export", "format", "cvs"},
                      {"table", "nodes", "1"},
                      {"table", "depths", "1"},
                      {"fit", "angle", "-1"},
                      {"fit", "like", "oak"}};
  for (const auto& [job, name, value] : kCases) {
    const auto refusal = [&job = job, &name = name, &value = value](Spelling spelling) {
      return error_of([&] { Arguments(params_of(find_job(job)), spelling).set(name, value); });
    };
    std::string expected = refusal(python_spelling);
    EXPECT_THAT(expected, HasSubstr(python_spelling(name) + ": ")) << job;
    expected.replace(0, name.size(), command_spelling(name));
    EXPECT_EQ(refusal(command_spelling), expected);
  }
}

}  // namespace
}  // namespace frond
