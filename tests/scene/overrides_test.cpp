// Overrides are written into the description of the scene, once.

#include "scene/overrides.h"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kScene = R"(
Option "integer seed" 7
Option "string wavelengths" "meyer"
Film "rgb" "integer xresolution" 64 "integer yresolution" 33
Sampler "independent" "integer pixelsamples" 48
Integrator "path" "integer maxdepth" 5
PixelFilter "gaussian" "float xradius" 2
WorldBegin
LightSource "infinite"
MakeNamedMaterial "blade" "string type" "leaf_lambert" "string specimen" "soybean"
MakeNamedMaterial "soil" "string type" "diffuse" "rgb reflectance" [.2 .3 .4]
)";

std::string text_of(const std::vector<ParsedParam>& params) {
  std::string text;
  for (const ParsedParam& p : params)
    std::visit([&](const auto& v) { text += fmt::format(" {} {}={}", p.type, p.name, fmt::join(v, " ")); }, p.values);
  return text;
}

/// Parts of the description that overrides may edit, as text.
std::map<std::string, std::string> parts_of(const SceneDescription& d) {
  std::map<std::string, std::string> parts{{"integrator", d.integrator.name + text_of(d.integrator.params)},
                                           {"filter", d.filter.name + text_of(d.filter.params)},
                                           {"film", d.film.name + text_of(d.film.params)},
                                           {"sampler", d.sampler.name + text_of(d.sampler.params)},
                                           {"camera", d.camera.name + text_of(d.camera.params)},
                                           {"wavelengths", read_options(d).wavelengths},
                                           {"seed", fmt::format("{}", d.seed.value_or(0))},
                                           {"quick", fmt::format("{}", d.is_quick)},
                                           {"file", fmt::format("{}", d.content_hash)}};
  for (const MaterialDescription& m : d.materials)
    parts["material " + m.name] = m.plugin.name + text_of(m.plugin.params);
  return parts;
}

class Overrides : public ::testing::Test {
 protected:
  SceneDescription edited(const SceneOverrides& overrides) const {
    SceneDescription description = scene_;
    apply_overrides(overrides, description, registry_, silent_log());
    return description;
  }
  Scene load(const SceneOverrides& overrides) { return {edited(overrides), registry_, pool_, silent_log()}; }

  ThreadPool pool_{1};
  Registry registry_ = make_registry(builtin_materials(), builtin_integrators());
  SceneDescription scene_ = parse_scene_text(kScene, "test.pbrt", silent_log());
};

struct Case {
  const char* part;
  SceneOverrides overrides;
  std::string after;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{{"material blade",
                                      {.swaps = {{"blade", {"leaf_solved", {{"thickness", "0.0002"}}}}}},
                                      "leaf_solved string specimen=soybean float thickness=0.0002"},
                                     {"material blade", {.swaps = {{"*", {"abm", {}}}}}, "abm string specimen=soybean"},
                                     {"material soil",
                                      {.swaps = {{"soil", {"diffuse", {{"reflectance", "0.5"}}}}}},
                                      "diffuse spectrum reflectance=360 0.5 2500 0.5"},
                                     {"wavelengths", {.wavelengths = "hero,lambdamin=400"}, "hero,lambdamin=400"},
                                     {"integrator",
                                      {.integrator = PluginText{"path", {{"cutoff", "0.1"}}}},
                                      "path integer maxdepth=5 float cutoff=0.1"},
                                     {"filter", {.filter = PluginText{"box", {}}}, "box"},
                                     {"seed", {.seed = 18446744073709551615u}, "18446744073709551615"},
                                     {"quick", {.quick = true}, "true"}};
  return all;
}

TEST_F(Overrides, EachEditsItsPartAndNoOther) {
  for (const Case& c : cases()) {
    auto expected = parts_of(scene_);
    EXPECT_NE(expected.at(c.part), c.after) << c.part;
    expected[c.part] = c.after;
    EXPECT_EQ(parts_of(edited(c.overrides)), expected) << c.part;
  }
  EXPECT_EQ(parts_of(edited({})), parts_of(scene_));
}

TEST_F(Overrides, ASecondTimeTheyChangeNothing) {
  for (const Case& c : cases()) {
    SceneDescription twice = edited(c.overrides);
    apply_overrides(c.overrides, twice, registry_, silent_log());
    EXPECT_EQ(parts_of(twice), parts_of(edited(c.overrides))) << c.part;
  }
}

TEST_F(Overrides, AreWhatTheSceneIsMadeBy) {
  const Scene own = load({});
  EXPECT_EQ(own.seed(), 7u);
  EXPECT_EQ(own.wavelengths_name(), "meyer");
  EXPECT_EQ(own.film().width, 64);
  EXPECT_EQ(own.samples_per_pixel(), 48);
  const Scene other = load({.wavelengths = "smpte", .seed = 18446744073709551615u, .quick = true});
  EXPECT_EQ(other.seed(), 18446744073709551615u) << "all 64 bits";
  EXPECT_EQ(other.wavelengths_name(), "smpte");
  EXPECT_EQ(other.film().width, 32);
  EXPECT_EQ(other.film().height, 17) << "rounded up";
  EXPECT_EQ(other.samples_per_pixel(), 3);
}

TEST_F(Overrides, SwapsAreMadeInTheirOrder) {
  const SceneOverrides overrides{.swaps = {{"leaf_lambert", {"abm", {}}}, {"abm", {"leaf_solved", {}}}}};
  EXPECT_THAT(parts_of(edited(overrides)).at("material blade"), StartsWith("leaf_solved"));
}

TEST_F(Overrides, ASwapWarnsOnceOfAllThatItLeavesOut) {
  class Warnings final : public Log {
   public:
    void info(std::string_view) const override {}
    void warn(const Location& where, std::string_view text) const override {
      texts.push_back(where.text() + std::string(text));
    }
    mutable std::vector<std::string> texts;
  } log;
  std::string scene = "WorldBegin\n";
  for (int i = 0; i < 14; ++i)
    scene += fmt::format("Material \"leaf_lambert\" \"string specimen\" \"maize\" \"float {}\" 3\n",
                         i % 2 == 0 ? "chlorophylla" : "carotenoids");
  SceneDescription description = parse_scene_text(scene, "test.pbrt", log);
  apply_overrides({.swaps = {{"*", {"diffuse", {}}}}}, description, registry_, log);
  EXPECT_THAT(log.texts, ElementsAre("test.pbrt:2:25: \"diffuse\" has no parameters \"specimen\", \"chlorophylla\", "
                                     "\"carotenoids\": left out by the swap"));
}

TEST_F(Overrides, ErrorsHaveThePlaceOfWhatAsks) {
  const Location where{std::make_shared<const std::string>("--swap blde=abm")};
  const auto swap = [&](const char* from, const PluginText& to) {
    return error_of([&] { edited({.swaps = {{from, to, where}}}); });
  };
  EXPECT_THAT(swap("blde", {"abm", {}}), StartsWith("--swap blde=abm: swap: the scene has no material \"blde\""));
  EXPECT_THAT(swap("blade", {"abn", {}}), StartsWith("--swap blde=abm: "));
  EXPECT_THAT(swap("blade", {"abm", {{"mod", "analog"}}}), HasSubstr("has no parameter \"mod\""));
  EXPECT_THAT(error_of([&] { edited({.integrator = PluginText{"pth", {}}}); }), HasSubstr("\"pth\""));
  EXPECT_THAT(error_of([&] { edited({.filter = PluginText{"box", {{"radius", "1"}}}}); }), HasSubstr("\"radius\""));
  EXPECT_THAT(error_of([&] { load({.wavelengths = "heroo"}); }), HasSubstr("\"heroo\""));
}

}  // namespace
}  // namespace frond
