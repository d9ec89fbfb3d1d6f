#include <gmock/gmock.h>

#include "jobs/record/job.h"
#include "render/measured_material.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"

/// A material in text, and the random numbers that follow from it.
namespace frond {
namespace {

using ::testing::HasSubstr;

TEST(MaterialText, IsOneWord) {
  EXPECT_EQ(material_text({"abm,specimen=maize"}), "abm,specimen=maize");
  EXPECT_EQ(material_text({"diffuse,reflectance=a b=c.spd"}), "diffuse,reflectance=a b=c.spd");
  EXPECT_EQ(material_text({}), "");
  EXPECT_THAT(error_of([] { material_text({""}); }), HasSubstr("a material is needed"));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"abm", "specimen=maize"}, {"abm specimen=maize"}, {"specimen=maize", "thickness=1e-4"}})
    EXPECT_THAT(error_of([&] { material_text(words); }), HasSubstr("one word with commas, as in leaf,specimen=maize"));
}

/// The seed is the same as when blanks separated the parameters, so that results do not change.
TEST(MaterialText, HasTheSeedOfItsWords) {
  EXPECT_EQ(material_seed("mix,materials=abm,diffuse,amount=0.2"), hash_bytes("mix materials=abm,diffuse amount=0.2"));
  EXPECT_EQ(material_seed("abm"), hash_bytes("abm"));
}

/// Figures of the program before materials were one text.
TEST(MaterialText, GivesTheFiguresOfEarlierVersions) {
  const Outcome o = frond_command({"spectrophotometer", "abm,specimen=maize", "--no-cache", "--wavelengths", "551",
                                   "--rays", "1e4", "--seed", "7", "--csv", "-"});
  EXPECT_EQ(parse_csv(o.out).text(0, "R"), "0.1123");
}

TEST(MeasureJobs, RefuseWithTheSameWordsInBothFrontEnds) {
  struct {
    std::string job, name, value;
  } const kCases[] = {{"spectrophotometer", "angles", "181"},
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
