#include "core/fluorescence.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "instruments/conformance/examination.h"
#include "tests/laws/setup.h"

namespace frond::test {
namespace {

/// A Lambertian fluorescence that obeys all laws, and ways to break one of them.
struct Planted : Fluorescence {
  double factor = 1;       ///< of the emission; f and photons alike
  double factor_of_f = 1;  ///< of f alone
  double offset = 0;       ///< added to f
  double above = 0;        ///< nm by which the gate opens too far
  double density = 1;      ///< of excitation
  bool noisy = false;

  std::string emission_shape() const override { return "planted"; }
  bool is_black() const override { return false; }
  bool is_noisy() const override { return noisy; }
  /// 1/nm of a side: half of the 0.9 that is absorbed, even over 640 to 850 nm, and gated.
  double side(double emission_nm, double excitation_nm, RandomStream& rng) const {
    const double gate = 1 / (1 + std::exp((excitation_nm - above - emission_nm) / 10));
    return factor * 0.45 / 211 * gate * (noisy ? 2 * rng.uniform_double() : 1);
  }
  double f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm, RandomStream& rng) const override {
    if (wo.z == 0 || wi.z == 0) return 0;
    return factor_of_f * side(emission_nm, excitation_nm, rng) / std::numbers::pi + offset;
  }
  FluorescencePhotons photons(const Vec3&, double emission_nm, double excitation_nm, RandomStream& rng) const override {
    const double m = side(emission_nm, excitation_nm, rng);
    return {.absorbed = 0.9, .emitted = 2 * m, .reabsorbed = 0, .lit_side = m, .opposite_side = m};
  }
  double excitation(double) const override { return density; }
};

std::string failures(const Fluorescence& fluorescence) {
  Findings found;
  check_fluorescence(fluorescence, "planted", {}, found);
  apply_false_alarm_rate(found, kFalseAlarmRate);
  return failures_text(found);
}

Planted with(double Planted::*member, double value) {
  Planted planted;
  planted.*member = value;
  return planted;
}

using ::testing::HasSubstr;

TEST(FluorescenceLaws, Hold) {
  EXPECT_EQ(failures(Planted()), "");
  Planted noisy;
  noisy.noisy = true;
  EXPECT_EQ(failures(noisy), "");
}

TEST(FluorescenceLaws, FindPlantedViolations) {
  EXPECT_THAT(failures(with(&Planted::factor, 1.05)), HasSubstr("more photons leave than are absorbed"));
  EXPECT_THAT(failures(with(&Planted::factor_of_f, 1.02)), HasSubstr("integral of f on the lit side"));
  EXPECT_THAT(failures(with(&Planted::above, 60)), HasSubstr("more than 60 nm shorter"));
  EXPECT_THAT(failures(with(&Planted::density, 0)), HasSubstr("where excitation is 0"));
  EXPECT_THAT(failures(with(&Planted::offset, -1)), HasSubstr("f is -"));
  EXPECT_THAT(failures(with(&Planted::factor_of_f, NAN)), HasSubstr("f is nan"));
  EXPECT_THAT(failures(with(&Planted::factor, -1)), HasSubstr("numbers of photons are negative"));
}

}  // namespace
}  // namespace frond::test
