#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "system/child_process.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"

/// `frond bench`. tests/instruments tests variances. No test here depends on measured times.
namespace frond {
namespace {

using ::testing::AllOf;
using testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using testing::IsEmpty;
using ::testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

/// As short as can be.
Outcome bench(const Words& arguments) {
  return frond_command(joined({"bench"}, arguments), {"--no-cache", "--min-time", "1e-6", "--repetitions", "2",
                                                      "--samples", "2000", "--threads", "2"});
}

Json json_of(const Words& arguments) {
  const Outcome o = bench(joined(arguments, {"--json", "-", "-q"}));
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, AnyOf(IsEmpty(), StartsWith("warning: the machine is busy")));
  return Json::parse(o.out);
}

std::vector<Json> runs_of(const Json& json, const std::string& name) {
  std::vector<Json> found;
  for (const Json& entry : json["benchmarks"])
    if (entry["name"] == name && entry["run_type"] == "iteration") found.push_back(entry);
  return found;
}

TEST(BenchCommand, JsonHasEachBenchmarkOnceForEachRepetition) {
  const Json json = json_of({"diffuse,reflectance=0.25", "--with", "diffusetransmission", "--angles", "0,135"});
  EXPECT_TRUE(json["context"].contains("machine"));
  EXPECT_EQ(json["context"]["executable"], "frond");
  size_t runs = 0;
  for (const Json& entry : json["benchmarks"]) runs += entry["run_type"] == "iteration" ? 1 : 0;
  EXPECT_EQ(runs, 2u * 4 * 2 * 4 * 2);
  for (const char* material : {"diffuse,reflectance=0.25", "diffusetransmission"})
    for (const char* call : {"sample", "f", "pdf", "hit"})
      for (const char* where : {"/theta:0", "/theta:135"})
        for (int lanes = 1; lanes <= 4; ++lanes) {
          const std::string name =
              "bsdf/" + std::string(material) + "/" + call + where + "/wavelengths:" + std::to_string(lanes);
          const auto found = runs_of(json, name);
          ASSERT_EQ(found.size(), 2u) << name;
          EXPECT_GT(found[0]["cpu_time"].get<double>(), 0);
          EXPECT_EQ(found[0]["time_unit"], "ns");
        }
}

TEST(BenchCommand, CountersTellWhatASampleIsWorth) {
  const Json json = json_of({"diffuse,reflectance=0.25", "--lanes", "3", "--angles", "45"});
  for (const Json& sample : runs_of(json, "bsdf/diffuse,reflectance=0.25/sample/theta:45/wavelengths:3")) {
    EXPECT_NEAR(sample["albedo"].get<double>(), 0.25, 1e-6);
    EXPECT_LT(sample["variance"].get<double>(), 1e-13);
    EXPECT_TRUE(sample.contains("variance_se"));
  }
  const auto hit = runs_of(json, "bsdf/diffuse,reflectance=0.25/hit/theta:45/wavelengths:3").at(0);
  // 6 standard errors, as batches are 64: false alarms in fewer than 1e-6 of all cases. The seed is fixed.
  EXPECT_NEAR(hit["sky"].get<double>(), 0.25, 6 * hit["sky_se"].get<double>());
  EXPECT_NEAR(hit["sun"].get<double>(), 0.25, 6 * hit["sun_se"].get<double>());
  EXPECT_GT(hit["sky_variance"].get<double>(), 100 * hit["sun_variance"].get<double>());
}

TEST(BenchCommand, TheSameCountersForTheSameSeed) {
  const auto variance = [](const std::string& seed) {
    const Json json = json_of({"diffusetransmission", "--angles", "0", "--lanes", "1", "--seed", seed});
    return runs_of(json, "bsdf/diffusetransmission/hit/theta:0/wavelengths:1").at(0)["sky_variance"].get<double>();
  };
  EXPECT_EQ(variance("1"), variance("1"));
  EXPECT_NE(variance("1"), variance("2"));
}

TEST(BenchCommand, MeasurementsCompareItsFiles) {
  const TestFolder folder("bench");
  const std::string a = folder.name_of("a.json"), b = folder.name_of("b.json"), page = folder.name_of("page.html");
  for (const std::string& file : {a, b})
    ASSERT_EQ(bench({"diffuse", "--angles", "0", "--lanes", "3", "--json", file, "-q"}).code, 0);
  const auto done = run_child({FROND_SOURCE_DIR "/measurements/run", "bench", "--compare", a, b, "-o", page}, "");
  ASSERT_TRUE(done);
  EXPECT_EQ(done->status, 0) << done->err;
  EXPECT_THAT(bytes_of(page),
              AllOf(HasSubstr("bsdf/diffuse/hit/theta:0/wavelengths:3"), HasSubstr("the same: all 6 figures")));
}

TEST(BenchCommand, TimesThePluginsMaterials) {
  const Outcome o = bench({"good_stochastic", "--plugin", FROND_TEST_PLUGINS "/planted.so", "--angles", "30"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("hit_ns"), ContainsRegex("good_stochastic +30 +4 +[0-9]")));
}

TEST(BenchCommand, DrawsVarianceAgainstTime) {
  const TestFolder folder("bench");
  const Outcome o = bench({"diffuse", "--with", "leaf_lambert", "--plot", folder.name_of("a.svg"), "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, IsEmpty());
  EXPECT_THAT(bytes_of(folder.name_of("a.svg")),
              AllOf(HasSubstr("leaf_lambert"), HasSubstr("under the sun"), HasSubstr("80° from the normal")));
}

/// An opaque surface seen from the back shows no light from the front.
TEST(BenchCommand, WhatIsBlackHasNoCostOfAnError) {
  const TestFolder folder("bench");
  const Outcome o = bench({"diffuse", "--angles", "135", "--lanes", "1", "--plot", folder.name_of("a.svg")});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, ContainsRegex("diffuse +135 +1 +0.5 +0 +0 +0 +0 +0 +0 +\n"));
  EXPECT_THAT(bytes_of(folder.name_of("a.svg")), AllOf(HasSubstr("</svg>"), Not(HasSubstr("nan"))));
}

TEST(BenchCommand, RefusesTheImpossibleBeforeItMeasures) {
  const auto refusal = [](std::vector<std::string> arguments) {
    const Outcome o = bench(arguments);
    EXPECT_EQ(o.code, 1) << ::testing::PrintToString(arguments);
    EXPECT_THAT(o.out, IsEmpty());
    return o.err;
  };
  EXPECT_THAT(refusal({"difuse"}), HasSubstr("diffuse"));
  EXPECT_THAT(refusal({"diffuse,reflectanc=1"}), HasSubstr("reflectance"));
  EXPECT_THAT(refusal({"diffuse,reflectance"}), HasSubstr("looks like name=value"));
  EXPECT_THAT(refusal({"diffuse", "--with", ""}), HasSubstr("a material is needed"));
  EXPECT_THAT(refusal({"diffuse", "--with", "diffuse"}), HasSubstr("twice"));
  EXPECT_THAT(refusal({"not_there", "--plugin", FROND_TEST_PLUGINS "/planted.so"}), HasSubstr("no surface"));
  EXPECT_THAT(refusal({"diffuse", "--angles", "90"}), HasSubstr("--angles"));
  EXPECT_THAT(refusal({"diffuse", "--lanes", "5"}), HasSubstr("--lanes"));
  EXPECT_THAT(refusal({"diffuse", "--lanes", "1.5"}), HasSubstr("--lanes"));
  EXPECT_THAT(refusal({"diffuse", "--wavelengths", "551", "--lanes", "2"}), HasSubstr("1 to 1"));
  EXPECT_THAT(refusal({"abm", "--wavelengths", "3000", "--lanes", "1"}), HasSubstr("3000"));
  EXPECT_THAT(refusal({"diffuse", "--wavelengths", "0"}), HasSubstr("--wavelengths"));
  EXPECT_THAT(refusal({"diffuse", "--plot", "a.gif"}), HasSubstr(".svg or a .png"));
  EXPECT_THAT(refusal({"diffuse", "--json", "/no/such/folder/a.json"}), HasSubstr("no folder"));
  EXPECT_THAT(refusal({"diffuse", "--angles", "0:70:10", "--plot", "a.svg"}), HasSubstr("marks"));
}

}  // namespace
}  // namespace frond
