#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/chart.h"
#include "study/compare/film_images.h"
#include "system/child_process.h"
#include "system/file_bytes.h"
#include "tests/study/compare_scene.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommand : public CommandTest {
 protected:
  Outcome compare(const Words& more, std::string_view scene = kLeafScene) const {
    return frond_command(
        {"compare", folder_.write("scene.pbrt", scene).string(), "-o", report(), "--cache", path("cache"),
         "--wavelengths", "smpte", "--size", "16", "--spp", "4", "--reference-spp", "8"},
        more);
  }
  std::string report() const { return path("report"); }
  std::string file(const std::string& name) const { return read_file_bytes(report() + "/" + name, {}); }
  nlohmann::json json() const { return nlohmann::json::parse(file("compare.json")); }
};

TEST_F(CompareCommand, MeasuresEveryCandidateOnEveryRung) {
  const Outcome o = compare({"--materials", "abm,leaf_simplified,oblateness=2", "--rms", "0.5"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("is enough for an RMS of 0.5, with 95 % confidence: 1 sample per pixel"));
  const auto j = json();
  ASSERT_EQ(j["candidates"].size(), 2u);
  EXPECT_EQ(j["candidates"][1]["label"], "leaf_simplified,oblateness=2");
  EXPECT_EQ(j["leaf_materials"], "blade");
  EXPECT_GT(j["foliar_ratio"], 0.05);
  ASSERT_EQ(j["comparison"].size(), 2u * 3 * 2 * 5);
  for (const auto& row : j["comparison"]) {
    EXPECT_GT(row["cpu_seconds"], 0);
    EXPECT_GT(row["flip"], 0);
  }
  for (const auto& candidate : j["candidates"])
    for (const int samples : {1, 2, 4})
      EXPECT_GT(row_of(j["comparison"], {{"candidate", candidate["label"]},
                                         {"samples", samples},
                                         {"region", "leaf"},
                                         {"channel", "green"}})["noise"],
                0);
  ASSERT_EQ(j["meets_rms"].size(), 2u);
  EXPECT_EQ(j["meets_rms"][1]["samples"], 1);
  const auto &abm = j["candidates"][0], &simplified = j["candidates"][1];
  EXPECT_EQ(abm["paper_cutoff"], 0.01);
  EXPECT_EQ(abm["paper_ratio_is_the_baselines"], true);
  EXPECT_EQ(simplified["paper_tree_depth"], abm["paper_tree_depth"]);
  EXPECT_THAT(std::string(simplified["paper_candidate"]),
              AllOf(HasSubstr("oblateness=2,surfacedirect=false@integrator=path,termination=attenuation,cutoff="),
                    HasSubstr(",maxdepth=" + fmt::format("{:.0f}", std::ceil(double(abm["paper_tree_depth"]))))));
  EXPECT_GT(simplified["paper_cpu_seconds_per_sample"], 0);
  const std::string csv = file("compare.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 6 + 2 * 3 * 2 * 5);
}

/// The default candidates take the textures that chemistry of a plant has.
TEST_F(CompareCommand, TheDefaultCandidatesTakeTexturesOfChemistry) {
  std::string scene(kLeafScene);
  scene.insert(scene.find("MakeNamedMaterial"),
               "Texture \"spots\" \"float\" \"checkerboard\" \"float tex1\" 2 "
               "\"float tex2\" 5\n");
  const std::string leaf = "\"string specimen\" \"soybean\"";
  scene.insert(scene.find(leaf) + leaf.size(), " \"texture chlorophylla\" \"spots\"");
  const Outcome o = compare({}, scene);
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("leaf_lambert"));
}

TEST_F(CompareCommand, TheReportNeedsNothingBesideIt) {
  ASSERT_EQ(compare({"--materials", "name <b>:abm"}).code, 0);
  const std::string html = file("index.html");
  EXPECT_THAT(html, AllOf(Not(HasSubstr("http")), Not(HasSubstr(" src=\"/")), Not(HasSubstr("{{")),
                          Not(HasSubstr("name <b>:")), HasSubstr("name &lt;b&gt;")));
  for (const char* chart : {"rms", "rms-leaf", "flip"}) {
    EXPECT_THAT(file(chart + std::string(".svg")), HasSubstr("<svg"));
    if (png_refusal().empty()) {
      EXPECT_EQ(file(chart + std::string(".png")).substr(1, 3), "PNG");
    }
  }
}

/// No letters that only readers of the paper know, and a command with its folders and quotes.
TEST_F(CompareCommand, IsReadWithoutThePaper) {
  const Outcome o = compare({"--materials", "abm;it's:leaf_simplified", "--exposure=-1"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out,
              AllOf(HasSubstr("equal samples  equal error  equal noise\n"),
                    HasSubstr("speed-up over abm (its CPU time divided by the candidate's) for an equal number of "
                              "samples;")));
  const std::string html = file("index.html");
  for (const std::string& text : {o.out, html.substr(0, html.find("<script"))})
    EXPECT_THAT(text, AllOf(Not(HasSubstr("(a)")), Not(HasSubstr("(b)")), Not(HasSubstr("(c")), Not(HasSubstr("(d)")),
                            Not(HasSubstr("manner"))));
  const std::string scene = path("scene.pbrt");
  EXPECT_THAT(html, HasSubstr("<code>frond compare " + scene + " --materials 'abm;it'\\''s:leaf_simplified'"));
  EXPECT_THAT(html, HasSubstr(" --exposure=-1 "));
}

TEST_F(CompareCommand, ContinuesTheReferenceFromTheCache) {
  ASSERT_EQ(compare({"--materials", "abm"}).code, 0);
  EXPECT_EQ(json()["reference_samples_from_cache"], 0);
  ASSERT_EQ(compare({"--materials", "abm"}).code, 0);
  const auto cached = json();
  EXPECT_EQ(cached["reference_samples_from_cache"], 8);
  ASSERT_EQ(frond_command({"compare", path("scene.pbrt"), "-o", report(), "--cache", path("cache"), "--wavelengths",
                           "smpte", "--size", "16", "--spp", "2", "--reference-spp", "16", "-q", "--materials", "abm"})
                .code,
            0);
  const auto continued = json();
  EXPECT_EQ(continued["reference_samples_from_cache"], 8);
  EXPECT_EQ(continued["reference_samples"], 16);
  EXPECT_LT(continued["reference"][0]["noise"], cached["reference"][0]["noise"]);
}

TEST_F(CompareCommand, ReplacesTheLeavesThatAreNamed) {
  std::string scene(kLeafScene);
  scene.replace(scene.find("NamedMaterial \"blade\"\n"), 0, "MakeNamedMaterial \"other\" \"string type\" \"abm\"\n");
  ASSERT_EQ(compare({"--materials", "abm", "--leaf", "blade"}, scene).code, 0);
  EXPECT_EQ(json()["leaf_materials"], "blade");
  ASSERT_EQ(compare({"--materials", "abm"}, scene).code, 0);
  EXPECT_EQ(json()["leaf_materials"], "blade, other");
  EXPECT_THAT(compare({"--materials", "abm", "--leaf", "blad"}, scene).err, HasSubstr("did you mean \"blade\"?"));
}

TEST_F(CompareCommand, ALeafThatNobodySeesIsNoError) {
  std::string scene(kLeafScene);
  scene.replace(scene.find("NamedMaterial \"blade\"\n"), 0, "Translate 0 -5 0\n");
  const Outcome o = compare({"--materials", "abm"}, scene);
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(file("index.html"), HasSubstr("There is nothing to draw"));
}

TEST_F(CompareCommand, BadRequestsAreRefused) {
  EXPECT_THAT(compare({"--materials", "leaves"}).err, HasSubstr("unknown material \"leaves\""));
  EXPECT_THAT(compare({"--materials", "abm,mood=weighted"}).err, HasSubstr("did you mean \"mode\"?"));
  for (const char* target : {"0.1,0.2", "0.01,0.01,0.01x", "0.01,0.01,-1"})
    EXPECT_THAT(compare({"--target", target}).err, HasSubstr("--target takes the RMS of red, green and blue"));
  EXPECT_THAT(compare({"--leaf", "foo"}).err, HasSubstr("no material \"foo\""));
  EXPECT_THAT(compare({"--rms", "0"}).err, HasSubstr("--rms: a list of numbers from 1e-06 to 1"));
  EXPECT_THAT(compare({"--materials", "abm@wavelengths=bands"}).err,
              HasSubstr("its wavelengths \"bands\" give other channels than the reference's \"smpte\""));
  std::string scene(kLeafScene);
  scene.replace(scene.find("leaf_simplified"), 15, "diffuse");
  scene.replace(scene.find("\"string specimen\" \"soybean\""), 27, "");
  EXPECT_THAT(compare({}, scene).err, HasSubstr("none of the materials is a leaf; --leaf names the one to replace"));
  EXPECT_FALSE(std::filesystem::exists(report())) << "a folder without a report";
}

TEST_F(CompareCommand, AFolderThatCannotBeIsRefusedFirst) {
  folder_.write("file", "");
  for (const char* folder : {"file", "file/report"})
    EXPECT_EQ(frond_command({"compare", "/no/such/scene.pbrt", "-o", path(folder)}).err.find("frond: cannot write"),
              0u);
}

/// In a real browser, where there is one: its script decodes every image and draws.
TEST_F(CompareCommand, TheReportRunsInABrowser) {
  const std::vector<std::string> browser{"chromium", "--headless=new", "--no-sandbox", "--disable-gpu"};
  const auto run = [&](const std::string& what, const std::string& url) {
    auto command = browser;
    command.insert(command.end(), {"--user-data-dir=" + path("profile"), "--virtual-time-budget=5000", what, url});
    return run_child(command, "");
  };
  ASSERT_EQ(compare({"--materials", "abm,leaf_simplified"}).code, 0);
  const std::string url = "file://" + report() + "/index.html";
  const auto dom = run("--dump-dom", url + "#mode=difference&a=1&b=2");
  if (!dom) GTEST_SKIP() << "chromium is not installed";
  EXPECT_THAT(dom->out,
              AllOf(HasSubstr("data-ready=\"5\""), HasSubstr("data-mode=\"difference\" aria-pressed=\"true\""),
                    HasSubstr("legend shown"), HasSubstr("luminance A minus B")));
  for (const auto& [link, width] : std::map<std::string, int>{{"#mode=side&zoom=3", 2 * 16 * 3 + 8},
                                                              {"#mode=wipe&zoom=2", 16 * 2},
                                                              {"#mode=flip&zoom=8&exposure=2", 16 * 8}})
    EXPECT_THAT(run("--dump-dom", url + link)->out, HasSubstr(fmt::format("width=\"{}\"", width))) << link;
  const std::string screenshot = path("screen.png");
  run("--screenshot=" + screenshot, url);
  EXPECT_EQ(read_file_bytes(screenshot, {}).substr(1, 3), "PNG");
}

TEST(FittingExposure, BringsTheBrightestTenthToTheMiddleOfTheScale) {
  using compare::fitting_exposure;
  const auto grey = [](float value) {
    Image image(10, 1, {"R", "G", "B"});
    std::ranges::fill(image.pixels, value);
    return image;
  };
  EXPECT_EQ(fitting_exposure(grey(0.3f)), 0);
  EXPECT_EQ(fitting_exposure(grey(0.3f / 8)), 3);
  EXPECT_EQ(fitting_exposure(grey(0.3f * 4)), -2);
  EXPECT_EQ(fitting_exposure(grey(0)), 0);
}

}  // namespace
}  // namespace frond
