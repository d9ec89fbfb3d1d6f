#include "instruments/sweep.h"

#include <gmock/gmock.h>

#include "core/texture.h"

namespace frond {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;

constexpr std::string_view kKinds[] = {"bifacial", "unifacial"};
constexpr Param kParams[] = {
    {.name = "thickness", .kind = ParamKind::real, .default_value = 1e-4, .range = {1e-6, 1e-2}, .doc = "m"},
    {.name = "pigment", .kind = ParamKind::real, .range = kAtLeastZero, .doc = "No default."},
    {.name = "rays", .kind = ParamKind::integer, .default_value = 1000000, .range = {1, 1e9}, .doc = "Pinned below."},
    {.name = "kind",
     .kind = ParamKind::string,
     .default_value = std::string_view("bifacial"),
     .doc = "A choice.",
     .choices = kKinds},
    {.name = "reflectance", .kind = ParamKind::spectrum_texture, .default_value = 0.5, .doc = "A spectrum."},
    {.name = "materials", .kind = ParamKind::material, .doc = "Names.", .list = true, .required = true},
};
const PluginInfo kInfo{"material", "test", "For tests.", "", kParams};

ParsedParam rays(double count) {
  ParsedParam p;
  p.type = "integer", p.name = "rays", p.values = std::vector<double>{count};
  return p;
}

std::vector<std::string> labels(const std::vector<ParameterSet>& sets) {
  std::vector<std::string> result;
  for (const ParameterSet& set : sets) result.push_back(set.label);
  return result;
}

PlainResolver no_materials() {
  return PlainResolver([](const std::string&) { return nullptr; });
}

TEST(ParameterSweep, BeginsWithTheDefaults) {
  const auto sets = parameter_sweep(kInfo, {});
  EXPECT_EQ(sets.front().label, "defaults");
  EXPECT_EQ(sets.front().plugin.params.size(), 1u) << "only what the plugin requires";
}

TEST(ParameterSweep, VisitsBothEndsOfEachRangeAndEachChoice) {
  EXPECT_THAT(labels(parameter_sweep(kInfo, {})),
              IsSupersetOf({"thickness = 1e-06", "thickness = 0.01", "pigment = 0", "pigment = 1000", "kind = bifacial",
                            "kind = unifacial", "reflectance = 0", "reflectance = 1"}));
}

TEST(ParameterSweep, PinnedParametersKeepTheirValue) {
  for (const ParameterSet& set : parameter_sweep(kInfo, {.pinned = {rays(100)}})) {
    const auto p = std::ranges::find(set.plugin.params, "rays", &ParsedParam::name);
    ASSERT_NE(p, set.plugin.params.end());
    EXPECT_EQ(std::get<std::vector<double>>(p->values), std::vector<double>{100});
  }
}

TEST(ParameterSweep, EverySetPassesTheParameterChecks) {
  PlainResolver resolver = no_materials();
  for (const ParameterSet& set : parameter_sweep(kInfo, {})) EXPECT_NO_THROW(Params(kInfo, set.plugin, resolver));
}

TEST(ParameterSweep, SameSeedGivesTheSameSets) {
  EXPECT_EQ(labels(parameter_sweep(kInfo, {.seed = 3})), labels(parameter_sweep(kInfo, {.seed = 3})));
  EXPECT_NE(labels(parameter_sweep(kInfo, {.seed = 3})), labels(parameter_sweep(kInfo, {.seed = 4})));
}

TEST(PlainResolver, SpectraAreLinearBetweenTheNumbersGiven) {
  PlainResolver resolver = no_materials();
  ParsedParam p;
  p.type = "spectrum", p.name = "s", p.values = std::vector<double>{400, 0.2, 500, 0.4, 700, 0};
  const SpectrumPtr s = resolver.spectrum(p, SpectrumUse::albedo);
  EXPECT_FLOAT_EQ(s->at(450), 0.3f);
  EXPECT_FLOAT_EQ(s->at(600), 0.2f);
  EXPECT_FLOAT_EQ(s->at(300), 0.2f);
  EXPECT_FLOAT_EQ(s->at(900), 0);
  EXPECT_FLOAT_EQ(s->max_value(), 0.4f);
  EXPECT_EQ(s->range_nm().min, 400);
  EXPECT_EQ(s->range_nm().max, 700);
}

}  // namespace
}  // namespace frond
