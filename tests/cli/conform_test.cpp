#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image_file.h"
#include "instruments/conformance/conformance.h"
#include "report/chart.h"
#include "tests/support/command_test.h"

/// `frond conform`; that each law can fail, and none does for long, is tested in tests/laws.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Outcome conform(const Words& arguments) {
  return frond_command({"conform", "--samples", "2000", "--angles", "0,60"}, arguments);
}

Outcome conform_planted(const Words& arguments) {
  return conform(joined(arguments, {"--plugin", FROND_TEST_PLUGINS "/planted.so"}));
}

TEST(Conform, LawfulMaterialsPass) {
  for (const std::vector<std::string>& material :
       std::vector<std::vector<std::string>>{{"diffuse"},
                                             {"diffuse,reflectance=1", "--lossless"},
                                             {"abm,specimen=maize"},
                                             {"mix,materials=abm,diffuse"},
                                             {"diffusetransmission", "--wavelengths", "400:700:50"}}) {
    const Outcome o = conform(material);
    EXPECT_EQ(o.code, 0) << o.out << o.err;
    EXPECT_THAT(o.out, Not(HasSubstr("BROKEN")));
  }
}

TEST(Conform, WhatDoesNotApplyIsNotAsked) {
  EXPECT_THAT(conform({"diffuse"}).out,
              AllOf(HasSubstr("holds      reciprocity"), HasSubstr("untested   unbiasedness")));
  EXPECT_THAT(conform({"abm"}).out, AllOf(HasSubstr("untested   reciprocity"), HasSubstr("holds      unbiasedness")));
}

TEST(Conform, ABrokenLawIsNamedAndExitsWithTwo) {
  const auto expect_broken = [](std::vector<std::string> material, const std::string& law) {
    const Outcome o = conform_planted(std::move(material));
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_THAT(o.out, AllOf(HasSubstr("BROKEN     " + law), HasSubstr("\nBroken: " + law + ".\n")));
    EXPECT_THAT(o.err, IsEmpty());
  };
  expect_broken({"wrong_warp"}, "sampling");
  expect_broken({"wrong_weight"}, "agreement");
  expect_broken({"wrong_pdf"}, "normalisation");
  expect_broken({"misses_a_way_out"}, "unbiasedness");
  expect_broken({"lost_energy", "--lossless"}, "energy");
  expect_broken({"one_way", "--reciprocal"}, "reciprocity");
  EXPECT_EQ(conform_planted({"good"}).code, 0);
  EXPECT_EQ(conform_planted({"good_stochastic"}).code, 0);
}

/// At the end of its range `picky` throws: an exception of the shared object, which the sweep knows as InputError.
TEST(Conform, ASweepPassesOverWhatAPluginRefuses) {
  EXPECT_EQ(conform_planted({"picky", "--sweep"}).code, 0);
  const Outcome bad_use = conform_planted({"picky,level=0.95"});
  EXPECT_EQ(bad_use.code, 1);
  EXPECT_THAT(bad_use.err, HasSubstr("frond: \"level\" is 0.95, and picky wants less than 0.9"));
  const Outcome refused = conform_planted({"picky_with_itself"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.out, AllOf(HasSubstr("BROKEN     parameters"), HasSubstr("picky wants less than 0.9")));
  EXPECT_THAT(refused.out, Not(HasSubstr("invisible")));
}

/// The default reflectance, 0.5, cannot show the error: the end of its range can.
TEST(Conform, FivePercentTooBrightIsFoundWithoutOptions) {
  const Outcome o = frond_command({"conform", "--plugin", FROND_TEST_PLUGINS "/planted.so", "too_bright"});
  EXPECT_EQ(o.code, 2) << o.out << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("BROKEN     energy"),
                           HasSubstr("directional albedo: at most 1.05 (reflectance = 1, 608 nm, wo at "),
                           HasSubstr("\nBroken: energy.\n")));
}

TEST(Conform, TheExampleForAuthorsHolds) {
  const Outcome o = frond_command({"conform", "--plugin", FROND_TEST_PLUGINS "/paper.so", "paper"});
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_THAT(o.out,
              HasSubstr("No law was found broken, at the defaults and at the ends of the ranges of reflectance.\n"));
}

TEST(Conform, TheGivenParametersAloneStateWhatTheyHide) {
  const Outcome o = conform_planted({"too_bright", "--given-only"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("No law was found broken, at the defaults only.\n"),
                           HasSubstr("directional albedo: at most 0.525 (defaults, 608 nm, wo at "),
                           HasSubstr("f too large everywhere by a factor of 1.9")));
  EXPECT_THAT(conform_planted({"too_bright,reflectance=0.5"}).out,
              HasSubstr("at the given parameters only: there is no other parameter with a range."));
  EXPECT_THAT(conform_planted({"good"}).out, HasSubstr("at the defaults only: there is no parameter with a range."));
  EXPECT_EQ(conform_planted({"good", "--given-only", "--sweep"}).code, 1);
}

TEST(Conform, RangesWithoutAnEndAreNamedAndSweptOnRequest) {
  const Outcome o = conform_planted({"unbounded"});
  EXPECT_EQ(o.code, 0) << o.out;
  EXPECT_THAT(o.out, AllOf(HasSubstr("at the defaults and at the ends of the ranges of scale.\n"),
                           HasSubstr("Not varied: scale (no upper end), note.\n")));
  EXPECT_EQ(conform_planted({"unbounded", "--sweep"}).code, 2);
}

TEST(Conform, RefusedEndsAreCounted) {
  EXPECT_THAT(conform_planted({"picky"}).out, HasSubstr("1 set of parameters is refused, the first with level = 1: "));
}

/// 2,000 samples alone would miss 5 %: the law of energy draws more, unless --excess forbids it.
TEST(Conform, FewSamplesAreEnoughOrSaySo) {
  const auto energy = [](const Words& more) {
    const Words words = joined({"abm,specimen=soybean", "--given-only", "--lossless", "--json", "-"}, more);
    return nlohmann::json::parse(conform(words).out)["laws"][size_t(Law::energy)];
  };
  EXPECT_LE(energy({})["detectable"], 0.05);
  EXPECT_GT(energy({"--excess", "0"})["detectable"], 0.05);
}

TEST(Conform, ASurfaceThatIsNotThereIsSaidToBe) {
  const Outcome o = conform_planted({"not_there"});
  EXPECT_EQ(o.code, 0);
  EXPECT_THAT(o.out, AllOf(HasSubstr("The surface is invisible"), Not(HasSubstr("No law was found broken"))));
}

TEST(Conform, JsonHasEveryLawAndFinding) {
  const Outcome o = conform_planted({"wrong_warp", "--json", "-"});
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_EQ(json["all_hold"], false);
  EXPECT_EQ(json["laws"].size(), kLaws.size());
  const auto law = [&json](Law l) { return json["laws"][size_t(l)]; };
  EXPECT_EQ(law(Law::sampling)["law"], "sampling");
  EXPECT_EQ(law(Law::sampling)["verdict"], "broken");
  EXPECT_EQ(law(Law::energy)["verdict"], "holds");
  EXPECT_EQ(law(Law::streams)["verdict"], "untested");
  EXPECT_EQ(law(Law::energy)["quantity"], "directional albedo");
  EXPECT_NEAR(law(Law::energy)["largest"], 0.8, 0.02);
  EXPECT_EQ(law(Law::energy)["largest_parameters"], "defaults");
  EXPECT_TRUE(law(Law::energy)["largest_wavelength_nm"].is_number());
  EXPECT_TRUE(law(Law::energy)["largest_theta_deg"].is_number());
  EXPECT_GT(law(Law::energy)["detectable"], 0);
  EXPECT_GT(law(Law::sampling)["largest"], law(Law::sampling)["detectable"]);
  EXPECT_TRUE(law(Law::streams)["detectable"].is_null());
  EXPECT_GT(json["detectable_factor"], 1.2);
  EXPECT_EQ(json["power"], 0.95);
  EXPECT_EQ(json["verdict"], "Broken: sampling.");
  int failures = 0;
  for (const auto& finding : json["findings"]) failures += finding["holds"] ? 0 : 1;
  EXPECT_EQ(failures, law(Law::sampling)["failures"]);
}

TEST(Conform, ImagesShowTheWorstFinding) {
  const TestFolder folder("conform");
  for (const char* material : {"wrong_warp", "lost_energy", "good"}) {
    if (!png_refusal().empty()) break;
    const std::string path = folder.name_of(std::string(material) + ".png");
    EXPECT_THAT(conform_planted({material, "--map", path}).err, IsEmpty());
    EXPECT_EQ(read_image(path, {}).image.width, 756);
  }
  const std::string svg = folder.name_of("a.svg");
  EXPECT_EQ(conform_planted({"wrong_warp", "--picture", svg}).code, 2);
  std::ifstream in(svg);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(text, AllOf(HasSubstr("sampling is broken"), HasSubstr("directions expected from pdf")));
}

TEST(Conform, BadUseExitsWithOne) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"difuse"},
                                             {"diffuse,reflectanc=1"},
                                             {"diffuse,reflectance"},
                                             {"diffuse,reflectance=2"},
                                             {"abm,specimen=rice"},
                                             {"abm", "--wavelengths", "3000"},
                                             {"mix"},
                                             {"diffuse", "--wavelengths", "0"},
                                             {"diffuse", "--map", "map.gif"},
                                             {"diffuse", "--json", "/no/such/folder/a.json"}}) {
    const Outcome o = conform(arguments);
    EXPECT_EQ(o.code, 1) << ::testing::PrintToString(arguments);
    EXPECT_THAT(o.err, Not(IsEmpty()));
    EXPECT_THAT(o.out, IsEmpty());
  }
  EXPECT_EQ(frond_command({"conform", "diffuse", "--angles", "90"}).code, 1);
  EXPECT_EQ(frond_command({"conform", "diffuse", "--samples", "10"}).code, 1);
}

}  // namespace
}  // namespace frond
