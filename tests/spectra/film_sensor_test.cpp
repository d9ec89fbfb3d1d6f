#include "spectra/color/film_sensor.h"

#include <gtest/gtest.h>

#include "spectra/beyond_data.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/daylight.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

Triple seen_by(const FilmSensor& film, const Spectrum& light) {
  Triple sum{};
  for (int nm = 360; nm <= 830; ++nm)
    for (size_t c = 0; c < 3; ++c) sum[c] += film.at(nm)[c] * double(light.at(float(nm)));
  return sum;
}

TEST(FilmSensor, TheEyeIsTheObserver) {
  const FilmSensor eye("cie1931", 0);
  for (const double nm : {300., 360., 411.25, 555., 830., 900.})
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(eye.at(nm)[c], cie_xyz(nm)[c], 1e-12) << nm;
}

/// The light that is to be white is white, of the luminance that it has: exactly to the eye; to cameras as well as the
/// patches can be matched at once.
TEST(FilmSensor, BalancesWhite) {
  const Triple white = kD65White.xyz();
  for (const std::string_view name : kFilmSensors)
    for (const double kelvin : {3000., 4500., 6500., 9000.}) {
      const SpectrumPtr light = daylight(kelvin);
      const double luminance = photometric(*light), tolerance = name == "cie1931" ? 1e-4 : 0.06;
      const Triple xyz = seen_by(FilmSensor(name, kelvin), *light);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(xyz[c] / luminance, white[c], tolerance) << name << ' ' << kelvin;
    }
}

TEST(Daylight, At6504KelvinIsD65) {
  const SpectrumPtr light = daylight(6500);
  for (float nm = 400; nm <= 700; nm += 5) EXPECT_NEAR(light->at(nm) / d65()->at(nm), 1, 2e-3) << nm;
}

TEST(BeyondData, IsZeroOrHeldInTheVisible) {
  const SpectrumPtr s = make_tabulated(std::vector<double>{450, 2, 620, 3}, {});
  const SpectrumPtr zero = beyond_data(s, Beyond::zero, kCieRange_nm),
                    held = beyond_data(s, Beyond::held, kCieRange_nm);
  EXPECT_EQ(zero->at(449.9f), 0);
  EXPECT_EQ(zero->at(450), 2);
  EXPECT_EQ(zero->at(620), 3);
  EXPECT_EQ(zero->at(621), 0);
  EXPECT_EQ(held->at(360), 2);
  EXPECT_EQ(held->at(830), 3);
  EXPECT_EQ(zero->range_nm().min, 360);
  EXPECT_EQ(held->range_nm().max, 830);
  const SpectrumPtr far = make_tabulated(std::vector<double>{300, 2, 900, 3}, {});
  EXPECT_EQ(beyond_data(far, Beyond::zero, kCieRange_nm), far);
  const SpectrumPtr red =
      beyond_data(make_tabulated(std::vector<double>{600, 2, 900, 3}, {}), Beyond::zero, kCieRange_nm);
  EXPECT_EQ(red->range_nm().max, 900);
  EXPECT_EQ(red->at(900), 3);
}

}  // namespace
}  // namespace frond
