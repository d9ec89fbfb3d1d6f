#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/log.h"
#include "image/image_file.h"
#include "render/plugins.h"
#include "scene/format/parser.h"
#include "scene/scene_options.h"
#include "study/choose/choice_report.h"
#include "tests/planted/planted.h"
#include "tests/study/choose_scene.h"
#include "tests/support/command_test.h"

namespace frond::choose {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;
using ::testing::StartsWith;

class Choosing : public CommandTest {
 protected:
  void SetUp() override { setenv("SOURCE_DATE_EPOCH", "0", 1); }

  Outcome render(const std::string& scene, const Words& more = {}) const {
    return frond_command(
        {"render", folder_.write("scene.pbrt", scene).string(), "-o", image(), "--cache", tables().name_of("")}, more);
  }
  std::string image() const { return path("image.exr"); }
  std::map<std::string, std::string> header() const { return read_image(image(), {}).header.text; }

  /// Made once for all tests here.
  static const TestFolder& tables() {
    static const TestFolder folder("choose_tables");
    return folder;
  }
};

const std::string kSmpte = "Option \"string wavelengths\" \"smpte\"\n";
const std::vector<std::string> kPilot{"--wavelengths", "smpte", "--pilot", "--json", "-"};
/// A long render, which is worth a pilot and which its noise target ends early.
const std::vector<std::string> kLong{"--wavelengths", "smpte", "--spp", "1e5", "--max-rms", "0.3"};

nlohmann::json choice_of(const Outcome& o) {
  EXPECT_EQ(o.code, 0) << o.err;
  return nlohmann::json::parse(o.out);
}

TEST_F(Choosing, WhatIsFarAwayMayBeSimpler) {
  const auto choice = choice_of(render(two_leaves("\"float maxrms\" 0.004", "\"float maxrms\" 0.01"), kPilot));
  ASSERT_EQ(choice["leaves"].size(), 2u);
  EXPECT_EQ(choice["leaves"][0]["name"], "near");
  EXPECT_NE(choice["leaves"][0]["chosen"], "leaf_lambert");
  EXPECT_EQ(choice["leaves"][1]["chosen"], "leaf_lambert");
  EXPECT_GT(choice["leaves"][0]["share"], choice["leaves"][1]["share"]);
  EXPECT_EQ(choice["ground"], "met");
  EXPECT_EQ(choice["rms"], 0.004);
  EXPECT_LT(choice["bias_high"], 0.004);
  EXPECT_FALSE(choice.contains("wavelengths"));
}

TEST_F(Choosing, TheLogAndTheHeaderSayWhatAndWhy) {
  const Outcome o = render(two_leaves("", ""), kLong);
  EXPECT_THAT(o.err, HasSubstr("leaf models for an RMS of 0.01, by a pilot of 2304 pixels"));
  EXPECT_THAT(o.err, HasSubstr("far, seen first by"));
  EXPECT_THAT(o.err, HasSubstr("* leaf_lambert"));
  const auto attributes = header();
  EXPECT_THAT(attributes.at("frond:leaf:far"), HasSubstr("leaf_lambert"));
  EXPECT_THAT(attributes.at("frond:choice"), StartsWith("an RMS of 0.0"));
}

TEST_F(Choosing, TheSameCommandGivesTheSameFileOnAnyThreads) {
  const std::string scene = two_leaves("", "");
  const auto bytes = [&](const char* threads) {
    EXPECT_EQ(render(scene, joined(kLong, {"-q", "--threads", threads})).code, 0);
    std::ifstream in(image(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string one = bytes("1");
  EXPECT_EQ(one, bytes("2"));
  EXPECT_EQ(one, bytes("1"));
}

TEST_F(Choosing, WhatCannotBeMetByLessIsSolved) {
  const Outcome o = render(two_leaves("\"float maxrms\" 1e-6", ""), kLong);
  EXPECT_THAT(o.err, Not(HasSubstr("warning: no")));
  EXPECT_EQ(header().at("frond:leaf:near"), "leaf_solved");
}

TEST_F(Choosing, NoPilotIsMadeThatCannotPay) {
  const Outcome o = render(two_leaves("", ""), {"--wavelengths", "smpte", "--spp", "4", "--json", "-"});
  const auto choice = nlohmann::json::parse(o.out)["choice"];
  EXPECT_EQ(choice["ground"], "no gain");
  EXPECT_EQ(choice["pilot"]["paths"], 0);
  for (const auto& leaf : choice["leaves"]) EXPECT_EQ(leaf["chosen"], "leaf_solved");
  EXPECT_EQ(header().at("frond:leaf:near"), "leaf_solved");
  EXPECT_THAT(o.err, HasSubstr("a pilot could take as long as simpler models can save in this render"));
}

TEST_F(Choosing, WhoNamesAModelHasIt) {
  const Outcome o = render(two_leaves("\"string model\" \"leaf_lambert\"", "\"string model\" \"leaf_lambert\""),
                           {"--wavelengths", "smpte", "--spp", "4", "--json", "-"});
  EXPECT_FALSE(nlohmann::json::parse(o.out).contains("choice"));
  EXPECT_THAT(header(), Not(Contains(Key("frond:choice"))));
}

TEST_F(Choosing, AnySceneCanBeAskedBySwapping) {
  const std::string fixed = "\"string model\" \"leaf_simplified\"";
  const Words more = joined(kPilot, {"--swap", "*=leaf,model=auto,maxrms=0.3"});
  const auto choice = choice_of(render(two_leaves(fixed, fixed), more));
  EXPECT_EQ(choice["rms"], 0.3);
  EXPECT_EQ(choice["leaves"].size(), 2u);
}

TEST_F(Choosing, TexturesOfCellWallsLeaveTheWalkAlone) {
  Image ramp(2, 1, {"R", "G", "B"});
  ramp.at(1, 0, 0) = ramp.at(1, 0, 1) = ramp.at(1, 0, 2) = 1;
  write_image(path("ramp.png"), ramp, {});
  std::string scene = two_leaves("\"texture spongyaspect\" \"ramp\"", "");
  scene.insert(scene.find("WorldBegin\n") + 11,
               "Texture \"ramp\" \"float\" \"imagemap\" \"string filename\" \"ramp.png\"\n");
  const auto choice = choice_of(render(scene, kPilot));
  EXPECT_EQ(choice["leaves"][0]["chosen"], "abm");
  EXPECT_EQ(choice["leaves"][0]["refused"].size(), 3u);
  EXPECT_THAT(choice["leaves"][0]["refused"][1]["reason"].get<std::string>(), HasSubstr("takes no texture"));
}

TEST_F(Choosing, APilotAloneRendersNothing) {
  const Outcome o = render(two_leaves("", ""), {"--wavelengths", "smpte", "--pilot", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(o.out)["leaves"][1]["chosen"], "leaf_lambert");
  EXPECT_FALSE(std::filesystem::exists(image()));
  const std::string fixed = "\"string model\" \"abm\"";
  EXPECT_THAT(render(two_leaves(fixed, fixed), {"--pilot"}).err, HasSubstr("leaves no leaf's model open"));
}

TEST_F(Choosing, BadRequestsAreRefusedWithTheirPlace) {
  EXPECT_THAT(render(two_leaves("\"float maxrms\" -1", "")).err, HasSubstr("\"maxrms\" is -1, outside its range"));
  EXPECT_THAT(render(two_leaves("\"string model\" \"leaf\"", "")).err, HasSubstr("\"model\" is one of auto"));
  EXPECT_THAT(render(two_leaves("\"float rms\" 0.1", "")).err, HasSubstr("maxrms"));
}

TEST_F(Choosing, BandsAreNoImage) {
  const Outcome o = render(two_leaves("", ""), {"--wavelengths", "bands,wavelengths=450,550", "--spp", "4"});
  EXPECT_EQ(o.code, 0);
  EXPECT_THAT(o.err, HasSubstr("bands are none"));
}

/// Light of a thousand times the radiance: an absolute error means another thing, a relative one the same.
TEST_F(Choosing, ARelativeErrorHasNoUnit) {
  const auto chosen = [&](const std::string& limit, const std::string& factor) {
    std::string scene = two_leaves(limit, limit);
    for (const std::string light : {"LightSource \"distant\" ", "LightSource \"infinite\" "})
      scene.insert(scene.find(light) + light.size(), "\"float scale\" " + factor + " ");
    if (const auto twice = scene.find("\"float scale\" 0.2"); twice != scene.npos) scene.erase(twice, 18);
    return choice_of(render(scene, kPilot));
  };
  const auto one = chosen("\"float maxrelativerms\" 0.03", "1"),
             bright = chosen("\"float maxrelativerms\" 0.03", "1024");
  EXPECT_TRUE(one["relative"]);
  EXPECT_EQ(one["rms"], 0.03);
  EXPECT_EQ(one["ground"], "met");
  for (const size_t leaf : {0u, 1u}) EXPECT_EQ(one["leaves"][leaf]["chosen"], bright["leaves"][leaf]["chosen"]);
  EXPECT_NEAR(one["bias_high"].get<double>(), bright["bias_high"].get<double>(), 1e-6);
  const auto absolute = chosen("\"float maxrms\" 0.03", "1"), of_bright = chosen("\"float maxrms\" 0.03", "1024");
  EXPECT_FALSE(absolute["relative"]);
  EXPECT_EQ(absolute["ground"], "met");
  EXPECT_EQ(absolute["leaves"][0]["chosen"], "leaf_lambert");
  EXPECT_EQ(of_bright["leaves"][0]["chosen"], "leaf_solved");
}

/// With both limits, the smaller one of each channel counts: here the absolute one, which is stricter.
TEST_F(Choosing, BothErrorsCanBeStated) {
  const std::string both = "\"float maxrms\" 1e-6 \"float maxrelativerms\" 0.5";
  EXPECT_EQ(choice_of(render(two_leaves(both, both), kPilot))["leaves"][0]["chosen"], "leaf_solved");
}

/// Returns the models selected for two leaves.
Choice chosen_from(const Ladder& ladder, Session& session, SceneDescription description) {
  return choose_models({.session = session, .description = description, .samples = 64, .is_question = true}, ladder,
                       silent_log())
      .value()
      .choice;
}

TEST_F(Choosing, TheDeadlineEndsAPilot) {
  Session session(silent_log(), {.threads = 2, .cache = tables().name_of("")});
  SceneDescription description = session.read(folder_.write("scene.pbrt", kSmpte + two_leaves("", "")));
  const auto chosen = choose_models({.session = session,
                                     .description = description,
                                     .samples = 1 << 20,
                                     .is_question = true,
                                     .deadline = std::chrono::steady_clock::now()},
                                    standard_ladder(session.registry()), silent_log());
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->choice.ground, Choice::Ground::no_time);
  EXPECT_EQ(chosen->choice.pilot.paths, 0u);
  for (const Answer& answer : chosen->choice.answers) EXPECT_EQ(answer.chosen, "leaf_solved");
  EXPECT_THAT(choice_text(chosen->choice), HasSubstr("the time limit ended the pilot"));
}

/// The deadline may come while the pilot makes tables or while it renders.
TEST_F(Choosing, TheDeadlineEndsAPilotAtAnyMoment) {
  const std::filesystem::path scene = folder_.write("scene.pbrt", kSmpte + two_leaves("\"float maxrms\" 1e-6", ""));
  int out_of_time = 0;
  for (const int milliseconds : {3, 30, 100, 200}) {
    Session session(silent_log(), {.threads = 2});
    SceneDescription description = session.read(scene);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    const auto chosen = choose_models(
        {.session = session, .description = description, .samples = 1 << 20, .is_question = true, .deadline = deadline},
        standard_ladder(session.registry()), silent_log());
    ASSERT_TRUE(chosen);
    out_of_time += chosen->choice.ground == Choice::Ground::no_time;
  }
  EXPECT_GT(out_of_time, 0);
}

/// A cheap and wrong model is the first of the ladder.
TEST_F(Choosing, AWrongModelIsNotChosenHoweverCheap) {
  const MaterialInfo wrong = test::planted<test::GoodLambertian>("planted_wrong");
  Session session(silent_log(), {.threads = 2});
  session.add_material(wrong);
  Ladder ladder = standard_ladder(session.registry());
  ladder.models.insert(ladder.models.begin(), {"planted_wrong", {"planted_wrong", {}}, 0.01});
  const Choice choice =
      chosen_from(ladder, session, session.read(folder_.write("scene.pbrt", kSmpte + two_leaves("", ""))));
  const Answer& near = choice.answers.front();
  EXPECT_EQ(near.findings.front().name, "planted_wrong");
  EXPECT_GT(near.findings.front().bias.low, 0.01);
  EXPECT_NE(near.chosen, "planted_wrong");
  EXPECT_EQ(choice.ground, Choice::Ground::met);
}

TEST_F(Choosing, WavelengthsAreAQuestionWhereNobodyNamesThem) {
  Session session(silent_log(), {.threads = 2});
  Ladder ladder = standard_ladder(session.registry());
  std::erase_if(ladder.models, [](const ModelOption& r) { return r.name != "leaf_lambert" && r.name != "abm"; });
  SceneDescription description = session.read(folder_.write("scene.pbrt", two_leaves("", "")));
  for (MaterialDescription& m : description.materials)
    if (m.plugin.name == "leaf") m.plugin.params.push_back({"float", "maxrms", {}, {}, std::vector<double>{0.3}});
  const Choice choice = chosen_from(ladder, session, description);
  ASSERT_EQ(choice.answers.size(), 3u);
  EXPECT_EQ(choice.answers[0].open_choice, "wavelengths");
  EXPECT_NE(choice.answers[0].chosen, "hero");
  EXPECT_EQ(choice.answers[1].chosen, "leaf_lambert");
}

/// Walks cannot be made reciprocal: their solution counts as exact.
TEST_F(Choosing, AReciprocalLeafIsHeldToTheSolvedOne) {
  Session session(silent_log(), {.threads = 2});
  SceneDescription description = session.read(folder_.write("scene.pbrt", kSmpte + two_leaves("", "")));
  for (MaterialDescription& m : description.materials)
    if (m.plugin.name == "leaf")
      m.plugin.params.push_back({"string", "incident", {}, {}, std::vector<std::string>{"reciprocal"}});
  const Choice choice = chosen_from(standard_ladder(session.registry()), session, description);
  for (const Answer& answer : choice.answers) EXPECT_NE(answer.chosen, "abm");
  EXPECT_EQ(choice.ground, Choice::Ground::met);
}

TEST_F(Choosing, TheAnswersAreWrittenIntoTheDescriptionAndTheRequest) {
  Session session(silent_log(), {.threads = 2, .cache = tables().name_of("")});
  const SceneDescription open = session.read(folder_.write("scene.pbrt", two_leaves("", "")));
  SceneDescription description = open;
  ImageRequest request;
  const auto choose = [&] {
    return choose_for({.session = session, .description = description, .samples = 4, .is_question = true}, request);
  };
  const auto chosen = choose();
  ASSERT_TRUE(chosen);
  EXPECT_FALSE(choose()) << "nothing is open any more";
  const Answer& first = chosen->choice.answers.front();
  EXPECT_EQ(first.open_choice, "wavelengths");
  EXPECT_EQ(read_options(description).wavelengths, first.chosen);
  EXPECT_THAT(request.attributes, Contains(Key("frond:choice")));
  EXPECT_EQ(session.load(description, request, chosen->scene.get()).image_format().space,
            session.load(open).image_format().space);
  EXPECT_EQ(request.color_space, "linear sRGB");
  description = open;
  request.color_space = "ACEScg";
  (void)choose();
  EXPECT_EQ(request.color_space, "ACEScg") << "who names a space has it";
}

/// The pilot's leaves are the very ones that a scene made for them has.
TEST_F(Choosing, AVariantRendersAsTheSceneItStandsFor) {
  const Registry registry = builtin_registry();
  ThreadPool pool(2);
  const Log& quiet = silent_log();
  const SceneDescription open = parse_scene(folder_.write("scene.pbrt", kSmpte + two_leaves("", "")), quiet);
  const SceneDescription closed = parse_scene(
      folder_.write("closed.pbrt",
                    kSmpte + two_leaves("\"string model\" \"leaf_simplified\"", "\"string model\" \"leaf_lambert\"")),
      quiet);
  const Scene scene(open, registry, pool, quiet), direct(closed, registry, pool, quiet);
  const Scene variant(closed, registry, pool, quiet, {}, &scene);
  EXPECT_EQ(&variant.geometry(), &scene.geometry());
  const FilmSettings film = Scene::film_settings(open, registry);
  PairedFilms a(film, 0, {1, 2}, open, registry, variant), b(film, 0, {1, 2}, open, registry, direct);
  a.advance_to(2, variant, pool, nullptr);
  b.advance_to(2, direct, pool, nullptr);
  ASSERT_EQ(a.film(0), b.film(0));
}

}  // namespace
}  // namespace frond::choose
