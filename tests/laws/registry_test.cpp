#include "materials/registry.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "core/texture.h"
#include "tests/laws/setup.h"
#include "tests/planted/planted.h"

/// All laws over all built-in materials.
namespace frond::test {
namespace {

/// Of each test here: with a handful of materials and five tests each, a new seed raises a false alarm in this file
/// less than once in 10,000 times.
constexpr double kFalseAlarmRate = 1e-6;

const MaterialInfo& material(std::string_view name) {
  return PluginTable<MaterialInfo>("material", builtin_materials()).get(name, {});
}

std::shared_ptr<Material> with_defaults(const MaterialInfo& info) {
  PlainResolver nothing([](const std::string&) { return nullptr; });
  return info.make(Params(info, {}, nothing));
}

/// Children of a `mix`: two built-in materials that differ in everything.
PlainResolver two_materials() {
  return PlainResolver([](const std::string& name) {
    return with_defaults(material(name == "one" ? "diffuse" : "diffusetransmission"));
  });
}

/// The same value at every wavelength.
ParsedParam level(const std::string& name, double value) {
  ParsedParam p;
  p.type = "spectrum", p.name = name, p.values = std::vector<double>{300, value, 3000, value};
  return p;
}

template <class T>
ParsedParam given(const std::string& type, const std::string& name, T value) {
  ParsedParam p;
  p.type = type, p.name = name, p.values = std::vector<T>{value};
  return p;
}

/// Tables that are quick to make: the laws hold for what is in them, be it as noisy as it may.
const SweepOptions kSweep{.pinned = {given("string", "tablemethod", std::string("montecarlo")),
                                     given("integer", "tablerays", 100.0), given("float", "tolerance", 0.02)}};

/// Runs the laws and fails the test where one is broken.
Findings expect_lawful(const MaterialInfo& info, std::span<const ParameterSet> sets,
                       const WavelengthStrategy& wavelengths, const ExaminationEffort& effort,
                       const Claims& claims = {}, PlainResolver resolver = two_materials()) {
  const Setup setup(wavelengths);
  Findings findings =
      examine(info, sets, {.preparation = setup.preparation, .resolver = resolver, .claims = claims, .effort = effort});
  judge(findings, kFalseAlarmRate);
  EXPECT_THAT(broken_laws(findings), ::testing::IsEmpty()) << failures_text(findings);
  return findings;
}

class Laws : public ::testing::TestWithParam<const MaterialInfo*> {
 protected:
  const MaterialInfo& info() const { return *GetParam(); }

  void expect_defaults_hold(const WavelengthStrategy& wavelengths) const {
    const auto sets = parameter_sweep(info(), kSweep);
    expect_lawful(info(), std::span(sets).first(1), wavelengths, {.samples = 60000});
  }
};

INSTANTIATE_TEST_SUITE_P(Registry, Laws, ::testing::ValuesIn(builtin_materials().begin(), builtin_materials().end()),
                         [](const auto& instance) { return std::string(instance.param->name); });

TEST_P(Laws, HoldAtTheDefaultsWithThreeWavelengths) { expect_defaults_hold(GivenWavelengths({608, 551, 455})); }

TEST_P(Laws, HoldAtTheDefaultsWithOneWavelength) { expect_defaults_hold(GivenWavelengths({550})); }

TEST_P(Laws, HoldAtTheDefaultsWithWavelengthsThatVary) { expect_defaults_hold(StratifiedWavelengths()); }

TEST_P(Laws, HoldAtTheDefaultsWithARetiredLane) {
  expect_defaults_hold(GivenWavelengths({430, 550, 670, 800}, {0, 2}));
}

TEST_P(Laws, HoldOverTheDeclaredBox) {
  const auto sets = parameter_sweep(info(), kSweep);
  const Findings findings =
      expect_lawful(info(), sets, GivenWavelengths({608, 551, 455}), {.samples = 4000, .angles_deg = {0, 50, 89}});
  const auto made = std::ranges::count(findings, Law::parameters, &Finding::law);
  EXPECT_GE(made, static_cast<ptrdiff_t>(sets.size() / 2)) << "most sets are refused: the sweep says little";
}

void expect_lossless(std::string_view name, std::vector<ParsedParam> params) {
  const ParameterSet set{"lossless", {std::string(name), {}, std::move(params)}};
  expect_lawful(material(name), {&set, 1}, GivenWavelengths({608, 551, 455}), {}, {.lossless = true});
}

TEST(Lossless, WhiteDiffuseReturnsAllLight) { expect_lossless("diffuse", {level("reflectance", 1)}); }

TEST(Lossless, DiffuseTransmissionReturnsAllLightWhereItsSharesAddUp) {
  expect_lossless("diffusetransmission", {level("reflectance", 0.7), level("transmittance", 0.3)});
}

TEST(Lossless, LeavesWithoutMesophyllReturnAllLight) {
  const ParsedParam nothing_absorbs = given("float", "mesophyllfraction", 0.0);
  for (const std::string specimen : {"soybean", "maize"})
    for (const std::string mode : {"analog", "weighted"})
      expect_lossless("abm", {nothing_absorbs, given("string", "specimen", specimen), given("string", "mode", mode)});
  for (const std::string incident : {"traced", "light"})
    expect_lossless("leaf_lambert", {nothing_absorbs, given("string", "incident", incident)});
  for (const std::string specimen : {"soybean", "maize"})
    expect_lossless("leaf_solved", {nothing_absorbs, given("string", "specimen", specimen)});
  for (const std::string method : {"montecarlo", "solve"})
    expect_lossless("leaf_simplified",
                    {nothing_absorbs, given("string", "tablemethod", method), given("integer", "tablerays", 100.0)});
}

// Nearly white, so that a mean of many samples is sharp: an f that is 3 % too small or too large is seen.
TEST(Abm, ObeysWithManySamplesWhereLittleIsAbsorbed) {
  for (const std::string specimen : {"soybean", "maize"}) {
    const ParameterSet set{specimen, {"abm", {}, {given("string", "specimen", specimen)}}};
    expect_lawful(material("abm"), {&set, 1}, GivenWavelengths({800}), {.samples = 300000, .angles_deg = {40}});
  }
}

TEST(LeafSolved, ObeysWithManySamplesWhereLittleIsAbsorbed) {
  for (const std::string specimen : {"soybean", "maize"}) {
    const ParameterSet set{specimen, {"leaf_solved", {}, {given("string", "specimen", specimen)}}};
    expect_lawful(material("leaf_solved"), {&set, 1}, GivenWavelengths({800}), {.samples = 300000, .angles_deg = {40}});
  }
}

TEST(LeafSimplified, ObeysWithATableThatWasSolved) {
  const ParameterSet set{"solved", {"leaf_simplified", {}, {given("string", "tablemethod", std::string("solve"))}}};
  expect_lawful(material("leaf_simplified"), {&set, 1}, GivenWavelengths({550}), {});
}

/// Of a `mix`, half and half, of a built-in material and another one.
void expect_lawful_mixture(const MaterialInfo& other,
                           const WavelengthStrategy& wavelengths = GivenWavelengths({608, 551, 455})) {
  const PlainResolver resolver([&other](const std::string& name) {
    return with_defaults(name == "one" ? material("diffusetransmission") : other);
  });
  const MaterialInfo& mix = material("mix");
  const auto sets = parameter_sweep(mix, {});
  expect_lawful(mix, std::span(sets).first(1), wavelengths, {}, {}, resolver);
}

TEST(Claims, DiffuseMaterialsAreReciprocalAndLeavesAreNot) {
  for (const MaterialInfo* info : builtin_materials()) {
    PlainResolver resolver = two_materials();
    const auto sets = parameter_sweep(*info, kSweep);
    const bool claims = info->make(Params(*info, sets[0].plugin, resolver))->is_reciprocal();
    EXPECT_EQ(claims, info->name != "abm" && !info->name.starts_with("leaf")) << info->name;
  }
}

struct NotThere final : Material {
  explicit NotThere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

TEST(Mix, ObeysWithAStochasticMaterialInIt) { expect_lawful_mixture(planted<GoodStochastic>("noisy")); }
TEST(Mix, ObeysWithARandomWalkInIt) { expect_lawful_mixture(material("abm")); }
TEST(Mix, ObeysWithANarrowLobeInIt) { expect_lawful_mixture(planted<GoodNarrowLobe>("narrow")); }
TEST(Mix, ObeysWithAMirrorInIt) { expect_lawful_mixture(planted<GoodCoatedDiffuse>("coated")); }
TEST(Mix, ObeysWhereOneMaterialIsNotThere) {
  const MaterialInfo not_there{{"material", "not_there", "", "", {}}, make_material<NotThere>};
  expect_lawful_mixture(not_there);
  expect_lawful_mixture(not_there, GivenWavelengths({420, 500, 580, 660}, {1}));
}

/// Lines of src/materials that define a plugin.
ptrdiff_t defined_materials() {
  ptrdiff_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FROND_SOURCE_DIR "/src/materials")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("extern const MaterialInfo") && line.find('{') != std::string::npos) ++count;
  }
  return count;
}

TEST(Registry, HoldsEveryMaterialThatIsDefined) {
  EXPECT_EQ(static_cast<ptrdiff_t>(builtin_materials().size()), defined_materials());
}

}  // namespace
}  // namespace frond::test
