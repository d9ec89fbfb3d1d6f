#include <gmock/gmock.h>

#include "study/compare/candidate.h"
#include "tests/support/input_error.h"

namespace frond::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

std::vector<std::string> labels(const std::vector<std::string>& texts) {
  std::vector<std::string> result;
  for (const Candidate& c : parse_candidates(texts)) result.push_back(c.label);
  return result;
}

TEST(Candidate, CommasSeparateWhatHasNoEqualsSign) {
  EXPECT_THAT(labels({"abm,leaf_simplified,tablemethod=solve,oblateness=3,abm,mode=weighted"}),
              ElementsAre("abm", "leaf_simplified,tablemethod=solve,oblateness=3", "abm,mode=weighted"));
}

TEST(Candidate, SemicolonsAndFurtherOptionsSeparateToo) {
  EXPECT_THAT(labels({"abm;abm,mode=weighted", "leaf_simplified"}),
              ElementsAre("abm", "abm,mode=weighted", "leaf_simplified"));
}

TEST(Candidate, MayHaveANameOfItsOwn) {
  const Candidate c = parse_candidate("weighted walk:abm,mode=weighted");
  EXPECT_EQ(c.label, "weighted walk");
  EXPECT_EQ(c.text, "abm,mode=weighted");
  EXPECT_EQ(c.material.name, "abm");
  EXPECT_THAT(c.material.params, ElementsAre(Pair("mode", "weighted")));
  EXPECT_EQ(parse_candidate("leaf_simplified,tablefile=c:/t.csv").label, "leaf_simplified,tablefile=c:/t.csv");
}

TEST(Candidate, BringsWavelengthsAndAnIntegrator) {
  const auto all = parse_candidates({"abm@wavelengths=hero,lambdamin=400@integrator=path,maxdepth=3,leaf_simplified"});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].wavelengths, "hero,lambdamin=400");
  ASSERT_TRUE(all[0].integrator);
  EXPECT_EQ(all[0].integrator->name, "path");
  EXPECT_THAT(all[0].integrator->params, ElementsAre(Pair("maxdepth", "3")));
  EXPECT_EQ(all[1].wavelengths, "");
}

TEST(Candidate, OtherFormsAreRefused) {
  EXPECT_THAT(error_of([] { parse_candidates({"abm@spp=3"}); }),
              HasSubstr("after @ a candidate has wavelengths=PLUGIN or integrator=PLUGIN: \"@spp=3\""));
  EXPECT_THAT(error_of([] { parse_candidates({"abm;abm"}); }),
              HasSubstr("two candidates are called \"abm\": give one a name, as in \"name:abm\""));
  EXPECT_NE(error_of([] { parse_candidates({"abm;"}); }), "");
  EXPECT_NE(error_of([] { parse_candidates({":abm"}); }), "");
}

}  // namespace
}  // namespace frond::compare
