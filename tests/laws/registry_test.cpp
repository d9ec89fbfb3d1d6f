#include "materials/registry.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "core/texture.h"
#include "tests/laws/setup.h"
#include "tests/planted/planted.h"
#include "tests/support/goniometer_text.h"
#include "tests/support/slow.h"

/// All laws over all built-in materials.
namespace frond::test {
namespace {

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

/// From one value at 400 nm to another at 700 nm.
ParsedParam falling(const std::string& name, double at_400, double at_700) {
  ParsedParam p;
  p.type = "spectrum", p.name = name, p.values = std::vector<double>{400, at_400, 700, at_700};
  return p;
}

/// Tables that are quick to make. The laws hold for any table, however noisy.
const SweepOptions kSweep{
    .pinned = {given("string", "tablemethod", std::string("montecarlo")), given("integer", "tablerays", 100.0),
               given("float", "tolerance", 0.02),
               // Layered materials: longer walks would not make the tests more sensitive.
               given("integer", "nsamples", 2.0), given("integer", "maxdepth", 20.0),
               given("string", "filename", std::string(FROND_SOURCE_DIR "/tests/pbrt_reference/metal.bsdf"))}};

/// For coated materials, roughness and g have likely values: with slopes a thousand times wider in one direction than
/// in the other, or g = 0.99 under a smooth coat, the mean of so few walks does not estimate the mean of f.
SweepOptions sweep_of(const MaterialInfo& info, bool smooth_coat = false) {
  SweepOptions options = kSweep;
  if (!info.name.starts_with("coated")) return options;
  options.pinned.push_back(given("float", "g", 0.4));
  for (const std::string prefix : {"", "interface.", "conductor."})
    for (const auto& [name, value] : {std::pair("roughness", 0.1), {"uroughness", 0.15}, {"vroughness", 0.1}})
      options.pinned.push_back(given("float", prefix + name, smooth_coat && prefix != "conductor." ? 0 : value));
  return options;
}

/// Fewer samples than scripts/test --slow takes, and over the box fewer angles: they find deviations twice as large
/// (power_test.cpp has its own).
constexpr int kFewer = 4;

/// Runs the laws and fails the test where one is broken.
Findings expect_lawful(const MaterialInfo& info, std::span<const ParameterSet> sets,
                       const WavelengthStrategy& wavelengths, ExaminationEffort effort, const Claims& claims = {},
                       PlainResolver resolver = two_materials()) {
  const Setup setup(wavelengths);
  if (!slow_tests()) effort.samples = std::max(effort.samples / kFewer, 1000);
  Findings findings =
      examine(info, sets, {.preparation = setup.preparation, .resolver = resolver, .claims = claims, .effort = effort});
  apply_false_alarm_rate(findings, kFalseAlarmRate);
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

void expect_lawful_over_the_box(const MaterialInfo& info, const SweepOptions& sweep) {
  const auto sets = parameter_sweep(info, sweep);
  ExaminationEffort effort{.samples = 4000, .angles_deg = {0, 50, 89}};
  if (!slow_tests()) effort.angles_deg = {0, 89};
  const Findings findings = expect_lawful(info, sets, GivenWavelengths({608, 551, 455}), effort);
  const auto made = std::ranges::count(findings, Law::parameters, &Finding::law);
  EXPECT_GE(made, static_cast<ptrdiff_t>(sets.size() / 2)) << "most sets are refused: the sweep says little";
}

TEST_P(Laws, HoldOverTheDeclaredBox) { expect_lawful_over_the_box(info(), sweep_of(info())); }

TEST(SmoothCoats, ObeyOverTheDeclaredBox) {
  for (const std::string_view name : {"coateddiffuse", "coatedconductor"})
    expect_lawful_over_the_box(material(name), sweep_of(material(name), true));
}

TEST(SmoothCoats, ObeyOverAMediumThatScattersEitherWay) {
  for (const double g : {-0.7, 0.0, 0.7})
    for (const std::string_view name : {"coateddiffuse", "coatedconductor"}) {
      const ParameterSet set{fmt::format("g = {}", g),
                             {std::string(name),
                              {},
                              {given("float", "g", g), level("albedo", 0.9), given("float", "thickness", 1.0),
                               given("integer", "maxdepth", 100.0)}}};
      expect_lawful(material(name), {&set, 1}, GivenWavelengths({608, 551, 455}), {});
    }
}

// A sheet whose sides differ, with few directions, in two files: with both sides lit, and with one.
TEST(GoniometerTable, Obeys) {
  const auto f = [](double incidence, double theta, double phi, double nm) {
    const bool front = incidence <= 90, lobe = theta < 90 && std::abs(phi - 180) < 50;
    return (front ? 0.08 : 0.03) * nm / 700 + (theta < 90 ? 0.02 : 0.05) + (lobe ? 0.3 : 0);
  };
  GoniometerAngles angles{{0, 50, 80}, {400, 550, 700}, {15, 40, 65, 85, 110, 150}, {0, 30, 130, 170, 180, 200, 290}};
  for (const bool both : {false, true}) {
    if (both) angles.incidences.insert(angles.incidences.end(), {120, 180});
    const std::string path = ::testing::TempDir() + "frond_goniometer.csv";
    std::ofstream(path) << goniometer_text(angles, f);
    const ParameterSet set{both ? "both sides" : "one side", {"measured", {}, {given("string", "filename", path)}}};
    expect_lawful(material("measured"), {&set, 1}, GivenWavelengths({608, 551, 455}),
                  {.samples = 10000, .angles_deg = {0, 30, 80}});
  }
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
  for (const std::string incident : {"traced", "light", "reciprocal"})
    expect_lossless("leaf_lambert", {nothing_absorbs, given("string", "incident", incident)});
  for (const std::string name : {"leaf_solved", "leaf_simplified"})
    for (const std::string specimen : {"soybean", "maize"})
      expect_lossless(name, {nothing_absorbs, given("string", "specimen", specimen),
                             given("string", "incident", std::string("reciprocal"))});
  for (const std::string specimen : {"soybean", "maize"})
    expect_lossless("leaf_solved", {nothing_absorbs, given("string", "specimen", specimen)});
  for (const std::string method : {"montecarlo", "solve"})
    expect_lossless("leaf_simplified",
                    {nothing_absorbs, given("string", "tablemethod", method), given("integer", "tablerays", 100.0)});
}

TEST(Lossless, DielectricsReturnAllLight) {
  expect_lossless("dielectric", {level("eta", 1.5)});
  expect_lossless("dielectric", {falling("eta", 1.8, 1.3)});
  expect_lossless("thindielectric", {falling("eta", 1.8, 1.3)});
}

TEST(Lossless, HairWithoutAbsorptionReturnsAllLight) {
  expect_lossless("hair", {level("sigma_a", 0)});
  expect_lossless("hair", {level("reflectance", 1), given("float", "beta_m", 0.1), given("float", "alpha", 30.0)});
}

TEST(Lossless, WhiteUnderASmoothCoatReturnsAllLight) {
  expect_lossless("coateddiffuse",
                  {level("reflectance", 1), given("float", "thickness", 0.0), given("integer", "maxdepth", 1000.0)});
  expect_lossless("coateddiffuse", {level("reflectance", 1), level("albedo", 1), given("float", "thickness", 0.5),
                                    given("float", "g", 0.5), given("integer", "maxdepth", 1000.0)});
}

// Where lanes are refracted by different angles.
TEST(Dispersion, Obeys) {
  const StratifiedWavelengths four;
  const GivenWavelengths three({608, 551, 455}), one({550}), with_retired({430, 550, 670, 800}, {0, 2});
  const ParameterSet sets[] = {
      {"smooth", {"dielectric", {}, {falling("eta", 1.8, 1.3)}}},
      {"rough", {"dielectric", {}, {falling("eta", 1.8, 1.3), given("float", "roughness", 0.05)}}},
      {"anisotropic",
       {"dielectric",
        {},
        {falling("eta", 0.8, 0.5), given("float", "uroughness", 0.4), given("float", "vroughness", 0.02)}}}};
  for (const WavelengthStrategy* wavelengths :
       std::initializer_list<const WavelengthStrategy*>{&four, &three, &one, &with_retired})
    expect_lawful(material("dielectric"), sets, *wavelengths, {});
  const ParameterSet coated{"coated",
                            {"coateddiffuse", {}, {falling("eta", 1.8, 1.3), given("float", "roughness", 0.05)}}};
  expect_lawful(material("coateddiffuse"), {&coated, 1}, three, {});
}

TEST(Rough, Obeys) {
  for (const double roughness : {0.003, 0.03, 0.3}) {
    const ParsedParam rough = given("float", "roughness", roughness);
    for (const std::string_view name : {"dielectric", "conductor", "coateddiffuse"}) {
      const ParameterSet set{std::to_string(roughness), {std::string(name), {}, {rough}}};
      expect_lawful(material(name), {&set, 1}, GivenWavelengths({608, 551, 455}), {});
    }
  }
}

// A reflection 1e-4 wide in one direction and as wide as the hemisphere in the other: the quadrature of pdf has nodes
// on either side of it, and 250 pilot samples do not lie in all of its parts.
TEST(Rough, ObeysWithFewSamplesWhereTheQuadratureOverlooksABand) {
  const ParameterSet band{
      "band",
      {"coateddiffuse",
       {},
       {given("float", "roughness", 0.0), given("float", "vroughness", 9.67319), given("float", "thickness", 2.9e-4),
        given("integer", "maxdepth", 4.0), given("integer", "nsamples", 3.0)}}};
  for (const int samples : {1000, 2000, 5000, 10000})
    expect_lawful(material("coateddiffuse"), {&band, 1}, GivenWavelengths({608, 551, 455}),
                  {.samples = samples, .angles_deg = {30}});
}

TEST(CoatedConductor, Obeys) {
  const ParsedParam scatters = level("albedo", 0.8), thick = given("float", "thickness", 0.3);
  const ParsedParam rough = given("float", "conductor.roughness", 0.05);
  const ParsedParam rough_coat = given("float", "interface.roughness", 0.05);
  const ParameterSet sets[] = {{"rough metal", {"coatedconductor", {}, {rough}}},
                               {"rough coat", {"coatedconductor", {}, {rough_coat}}},
                               {"both rough", {"coatedconductor", {}, {rough, rough_coat}}},
                               {"smooth, medium", {"coatedconductor", {}, {scatters, thick}}},
                               {"rough, medium", {"coatedconductor", {}, {scatters, thick, rough, rough_coat}}}};
  expect_lawful(material("coatedconductor"), sets, GivenWavelengths({608, 551, 455}), {});
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

/// Tests a `mix` of equal shares of a built-in material and another one.
void expect_lawful_mixture(const MaterialInfo& other,
                           const WavelengthStrategy& wavelengths = GivenWavelengths({608, 551, 455})) {
  const PlainResolver resolver([&other](const std::string& name) {
    return with_defaults(name == "one" ? material("diffusetransmission") : other);
  });
  const MaterialInfo& mix = material("mix");
  const auto sets = parameter_sweep(mix, {});
  expect_lawful(mix, std::span(sets).first(1), wavelengths, {}, {}, resolver);
}

TEST(Claims, ModelsButLeavesAndHairAreReciprocal) {
  for (const MaterialInfo* info : builtin_materials()) {
    PlainResolver resolver = two_materials();
    const auto sets = parameter_sweep(*info, kSweep);
    const bool claims = info->make(Params(*info, sets[0].plugin, resolver))->is_reciprocal();
    EXPECT_EQ(claims, info->name != "measured" && info->name != "hair" && !info->leaf) << info->name;
  }
}

struct NotThere final : Material {
  explicit NotThere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

/// A built-in material with its parameters, as one half of a `mix`.
struct Half {
  std::string name;
  std::vector<ParsedParam> params = {};
};
const Half kOpaque{"diffuse"}, kSheet{"diffusetransmission"}, kPane{"thindielectric"};
const Half kGlass{"dielectric", {level("eta", 1.5), given("float", "roughness", 0.3)}};
const Half kWater{"dielectric", {level("eta", 1.3), given("float", "roughness", 0.3)}};

/// The two halves of the first set in the sweep of `mix`.
class Halves {
 public:
  Halves(const Half& one, const Half& two) : one_(one), two_(two) {}

  bool claims_reciprocity() { return info_.make(Params(info_, sets_[0].plugin, resolver_))->is_reciprocal(); }
  std::set<Law> broken(const Claims& claims) {
    const GivenWavelengths three({608, 551, 455});
    const Setup setup(three);
    Findings findings = examine(
        info_, std::span(sets_).first(1),
        {.preparation = setup.preparation, .resolver = resolver_, .claims = claims, .effort = {.samples = 4000}});
    apply_false_alarm_rate(findings, kFalseAlarmRate);
    return broken_laws(findings);
  }

 private:
  const Half &one_, &two_;
  const MaterialInfo& info_ = material("mix");
  std::vector<ParameterSet> sets_ = parameter_sweep(info_, {});
  PlainResolver resolver_{[this](const std::string& name) {
    const Half& half = name == "one" ? one_ : two_;
    const MaterialInfo& info = material(half.name);
    PlainResolver nothing([](const std::string&) { return nullptr; });
    return std::shared_ptr<Material>(info.make(Params(info, {half.name, {}, half.params}, nothing)));
  }};
};

TEST(Mix, ClaimsReciprocityWhereNothingIsRefracted) {
  const std::initializer_list<const Half*> all{&kOpaque, &kSheet, &kPane, &kGlass, &kWater};
  for (const Half* one : all)
    for (const Half* two : all) {
      Halves mix(*one, *two);
      const bool refracts = one->name == "dielectric" || two->name == "dielectric";
      EXPECT_EQ(mix.claims_reciprocity(), !refracts) << one->name << ", " << two->name;
      if (refracts) continue;
      EXPECT_THAT(mix.broken({}), ::testing::IsEmpty()) << one->name << ", " << two->name;
    }
}

/// A mixture need not claim reciprocity: it has a single index, by which the laws convert radiance to power.
TEST(Mix, IsReciprocalUnlessBothLetLightThroughAndRefractItOtherwise) {
  const Claims reciprocal{.reciprocal = true};
  EXPECT_THAT(Halves(kOpaque, kGlass).broken(reciprocal), ::testing::IsEmpty());
  EXPECT_THAT(Halves(kGlass, kGlass).broken(reciprocal), ::testing::IsEmpty());
  for (const auto& [one, two] : {std::pair(&kGlass, &kSheet), {&kSheet, &kGlass}, {&kGlass, &kWater}})
    EXPECT_THAT(Halves(*one, *two).broken(reciprocal), ::testing::Contains(Law::reciprocity));
}

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
  EXPECT_EQ(static_cast<ptrdiff_t>(builtin_materials().size()), defined_materials() + 1);  // the open leaf
}

}  // namespace
}  // namespace frond::test
