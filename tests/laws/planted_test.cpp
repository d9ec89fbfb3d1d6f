#include "tests/planted/planted.h"

#include <gmock/gmock.h>

#include "tests/laws/setup.h"

namespace frond::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Findings findings(const MaterialInfo& info, const Claims& claims = {},
                  const WavelengthStrategy& wavelengths = GivenWavelengths({608, 551, 455}),
                  const ExaminationEffort& effort = {}) {
  const Setup setup(wavelengths);
  PlainResolver resolver([](const std::string&) { return nullptr; });
  const auto sets = parameter_sweep(info, {});
  Findings found =
      examine(info, std::span(sets).first(1),
              {.preparation = setup.preparation, .resolver = resolver, .claims = claims, .effort = effort});
  apply_false_alarm_rate(found, kFalseAlarmRate);
  return found;
}

template <class B>
std::set<Law> broken(const Claims& claims = {},
                     const WavelengthStrategy& wavelengths = GivenWavelengths({608, 551, 455})) {
  return broken_laws(findings(planted<B>("planted"), claims, wavelengths));
}

template <class B>
class GoodBsdf : public ::testing::Test {};
using GoodBsdfs = ::testing::Types<GoodLambertian, GoodLossless, GoodNarrowLobe, GoodCoatedDiffuse, GoodStochastic>;
TYPED_TEST_SUITE(GoodBsdf, GoodBsdfs);

TYPED_TEST(GoodBsdf, BreaksNoLaw) {
  const auto found = findings(planted<TypeParam>("good"));
  EXPECT_EQ(failures_text(found), "");
}

TYPED_TEST(GoodBsdf, BreaksNoLawWithOneWavelength) {
  EXPECT_THAT(broken<TypeParam>({}, GivenWavelengths({550})), IsEmpty());
}

TYPED_TEST(GoodBsdf, BreaksNoLawWithARetiredLane) {
  EXPECT_THAT(broken<TypeParam>({}, GivenWavelengths({420, 500, 580, 660}, {1})), IsEmpty());
}

TEST(GoodClaims, Hold) {
  EXPECT_THAT((broken<GoodLossless>({.lossless = true, .reciprocal = true})), IsEmpty());
  EXPECT_THAT((broken<FromLight<GoodLossless>>({.lossless = true})), IsEmpty());
}

TEST(Planted, PdfWithoutTheLobesProbabilityBreaksNormalisation) {
  EXPECT_THAT(broken<PdfWithoutProbability>(), ElementsAre(Law::normalisation));
}

TEST(Planted, SampleThatGivesUpUnannouncedBreaksNormalisation) {
  EXPECT_THAT(broken<SampleGivesUp>(), ElementsAre(Law::normalisation));
}

TEST(Planted, ApproximatePdfThatIntegratesToMoreBreaksNormalisation) {
  EXPECT_THAT(broken<ApproximatePdfTooLarge>(), ElementsAre(Law::normalisation));
}

TEST(Planted, TransmissionThatFlagsDenyBreaksFlags) {
  EXPECT_THAT(broken<HiddenTransmission>(), ElementsAre(Law::flags));
}

TEST(Planted, TransmittedSampleCalledReflectedBreaksFlags) {
  EXPECT_THAT(broken<FalseSampleFlag>(), ElementsAre(Law::flags));
}

TEST(Planted, OnePercentLostBreaksEnergyWhereLosslessIsClaimed) {
  EXPECT_THAT(broken<LostEnergy>(), IsEmpty());
  EXPECT_THAT((broken<LostEnergy>({.lossless = true})), ElementsAre(Law::energy));
  EXPECT_THAT((broken<FromLight<LostEnergy>>({.lossless = true})), ElementsAre(Law::energy));
}

TEST(Planted, OnePercentGainedBreaksEnergy) {
  EXPECT_THAT(broken<GainedEnergy>(), ElementsAre(Law::energy));
  EXPECT_THAT((broken<FromLight<GainedEnergy>>()), ElementsAre(Law::energy));
}

TEST(Planted, WrongWarpBreaksSampling) { EXPECT_THAT(broken<WrongWarp>(), ElementsAre(Law::sampling)); }

TEST(Planted, LobesChosenInOtherSharesThanThePdfSaysBreakSampling) {
  EXPECT_THAT(broken<WrongLobeChoice>(), ElementsAre(Law::sampling));
}

TEST(Planted, NarrowLobeOfAnotherExponentBreaksSampling) {
  EXPECT_THAT(broken<WrongExponent>(), ElementsAre(Law::sampling));
}

TEST(Planted, SampleWithAnotherFBreaksAgreement) {
  EXPECT_THAT(broken<SampleOfAnotherF>(), ElementsAre(Law::agreement));
}

TEST(Planted, NanAtGrazingBreaksValues) { EXPECT_THAT(broken<NanAtGrazing>(), ElementsAre(Law::values)); }

TEST(Planted, AnExceptionBreaksValues) {
  const auto found = findings(planted<ThrowsAtGrazing>("throws"));
  EXPECT_THAT(broken_laws(found), ElementsAre(Law::values));
  EXPECT_THAT(failures_text(found), HasSubstr("an exception is thrown: cos theta is too small"));
}

TEST(Planted, ScatteringAtZeroCosineBreaksValues) {
  EXPECT_THAT(broken<ScattersAtZeroCosine>(), ElementsAre(Law::values));
}

TEST(Planted, NegativeFBreaksValues) { EXPECT_THAT(broken<NegativeF>(), ElementsAre(Law::values)); }

TEST(Planted, WorkForARetiredLaneBreaksLanes) {
  EXPECT_THAT((broken<WorksForRetiredLane>({}, GivenWavelengths({420, 500, 580, 660}, {1}))), ElementsAre(Law::lanes));
  EXPECT_THAT(broken<WorksForRetiredLane>(), ElementsAre(Law::lanes));  // a lane is retired if none is
}

TEST(Planted, OneWayStreetThatClaimsReciprocityBreaksIt) {
  EXPECT_THAT(broken<OneWay>(), IsEmpty());
  EXPECT_THAT((broken<OneWay>({.reciprocal = true})), ElementsAre(Law::reciprocity));
}

TEST(Planted, NoisyOneWayStreetThatClaimsReciprocityBreaksIt) {
  EXPECT_THAT((broken<GoodStochastic>({.reciprocal = true})), IsEmpty());
  EXPECT_THAT(broken<StochasticOneWay>(), IsEmpty());
  EXPECT_THAT((broken<StochasticOneWay>({.reciprocal = true})), ElementsAre(Law::reciprocity));
}

TEST(Planted, StochasticFThatMissesAWayOutBreaksUnbiasedness) {
  EXPECT_THAT(broken<StochasticMissesAWayOut>(), ElementsAre(Law::unbiasedness));
}

TEST(Planted, StochasticFWrongByAFifthInAConeBreaksUnbiasedness) {
  EXPECT_THAT(broken<StochasticWrongByLittle>(), ElementsAre(Law::unbiasedness));
}

TEST(Planted, NoiseMadeFromDirectionsBreaksStreams) {
  EXPECT_THAT(broken<NoiseFromDirections>(), ElementsAre(Law::streams));
}

TEST(Planted, TransmissionThatIsNeverSampledBreaksCoverage) {
  EXPECT_THAT(broken<NeverSamplesTransmission>(), ElementsAre(Law::coverage));
}

// Maps.

/// Returns the map of directions of one law's worst finding.
SphereMap map_of_worst(const MaterialInfo& info, Law law, const Claims& claims = {}) {
  const Findings found = findings(info, claims, GivenWavelengths({608, 551, 455}), {.maps = true});
  return *summarise(found)[static_cast<size_t>(law)].worst->map;
}

TEST(Maps, CountEveryDirectionOnce) {
  const SphereMap map = map_of_worst(planted<GoodLambertian>("good"), Law::sampling);
  double found = 0, expected = 0, solid_angle = 0;
  for (const SphereMap::Patch& p : map.patches)
    found += p.found, expected += p.expected, solid_angle += p.box.solid_angle();
  EXPECT_EQ(found, ExaminationEffort().samples);
  EXPECT_NEAR(expected, found, 1e-6);
  EXPECT_NEAR(solid_angle, 4 * kPi, 1e-5);
}

/// Uniform in place of cosine: 1 / (2 |cos theta|) as many as there should be. 6 standard errors in each of some 130
/// patches.
TEST(Maps, ShowWhereAWarpIsWrong) {
  for (const SphereMap::Patch& p : map_of_worst(planted<WrongWarp>("warp"), Law::sampling).patches) {
    const double ratio = 1 / std::abs(p.box.z0 + p.box.z1);
    EXPECT_NEAR(p.found / p.expected, ratio, 6 * std::sqrt(ratio / p.expected));
  }
}

TEST(Maps, ShowTheFactorOfAWrongWeight) {
  for (const SphereMap::Patch& p : map_of_worst(planted<SampleOfAnotherF>("f"), Law::agreement).patches)
    EXPECT_NEAR(p.found / p.expected, 1.01, 1e-4);
}

// Parameters.

constexpr Param kLevel[] = {
    {.name = "level", .kind = ParamKind::real, .default_value = 0.5, .range = {0, 1}, .doc = "A level."}};

TEST(Planted, DeclaredParameterThatIsNeverReadBreaksParameters) {
  EXPECT_THAT(broken_laws(findings(planted<GoodLambertian>("unread", kLevel))), ElementsAre(Law::parameters));
}

struct ReadsUndeclared final : Material {
  explicit ReadsUndeclared(const Params& p) { p.real("secret"); }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

TEST(Planted, ReadingAnUndeclaredParameterBreaksParameters) {
  const MaterialInfo info{{"material", "reads_undeclared", "", "", {}}, make_material<ReadsUndeclared>};
  EXPECT_THAT(broken_laws(findings(info)), ElementsAre(Law::parameters));
}

struct RefusesItsDefaults final : Material {
  explicit RefusesItsDefaults(const Params& p) { fail(p.where("level"), "{} is too much", p.real("level")); }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

TEST(Planted, RefusingItsOwnDefaultsBreaksParameters) {
  const MaterialInfo info{{"material", "refuses", "", "", kLevel}, make_material<RefusesItsDefaults>};
  EXPECT_THAT(broken_laws(findings(info)), ElementsAre(Law::parameters));
}

}  // namespace
}  // namespace frond::test
