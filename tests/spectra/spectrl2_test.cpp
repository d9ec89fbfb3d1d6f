#include "spectra/spectrl2.h"

#include <gtest/gtest.h>

#include "spectra/csv_columns.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

TEST(Spectrl2, AgreesWithPvlibForEveryInput) {
  const auto table = csv_columns(read_file_bytes(FROND_SOURCE_DIR "/tests/reference/spectrl2.csv", {}));
  constexpr size_t kWavelengths = 107;
  ASSERT_EQ(table[0].size(), 8 * kWavelengths);
  for (size_t row = 0; row < table[0].size(); ++row) {
    const auto at = [&](size_t column) { return table[column][row]; };
    const ClearSkyIrradiance e = spectrl2({.sun_zenith_deg = at(0),
                                           .aerosol = at(1),
                                           .angstrom = at(2),
                                           .water_cm = at(3),
                                           .ozone_atm_cm = at(4),
                                           .pressure_Pa = at(5),
                                           .albedo = at(6),
                                           .day = int(at(7))});
    const size_t i = row % kWavelengths;
    ASSERT_EQ(e.nm[i], at(8));
    // The reference has six digits.
    EXPECT_NEAR(e.extraterrestrial[i], at(9), 1e-5 * at(9)) << row;
    EXPECT_NEAR(e.direct_normal[i], at(10), 1e-5 * at(10)) << row;
    EXPECT_NEAR(e.diffuse[i], at(11), 1e-5 * at(11)) << row;
  }
}

TEST(Spectrl2, AirMassAndDistanceAreTheirKnownValues) {
  EXPECT_NEAR(relative_air_mass(0), 0.999712, 1e-6);
  EXPECT_NEAR(relative_air_mass(80), 5.586036, 1e-6);
  EXPECT_NEAR(relative_air_mass(90), 37.9196, 1e-3);                   // Kasten and Young 1989 give 38
  EXPECT_NEAR(sun_distance_factor(4), 1 / (0.9833 * 0.9833), 1e-3);    // perihelion
  EXPECT_NEAR(sun_distance_factor(186), 1 / (1.0167 * 1.0167), 1e-3);  // aphelion
}

TEST(Spectrl2, WithoutAnAtmosphereTheSunIsExtraterrestrialAndTheSkyBlack) {
  const ClearSkyIrradiance e = spectrl2({.sun_zenith_deg = 50,
                                         .aerosol = 0,
                                         .water_cm = 0,
                                         .ozone_atm_cm = 0,
                                         .pressure_Pa = 0,
                                         .albedo = 0.5,
                                         .day = 1});
  for (size_t i = 0; i < e.nm.size(); ++i) {
    EXPECT_DOUBLE_EQ(e.direct_normal[i], e.extraterrestrial[i]);
    EXPECT_EQ(e.diffuse[i], 0);
  }
}

TEST(Spectrl2, IsFiniteAndNotNegativeAtTheEndsOfItsRanges) {
  for (const double zenith : {0.0, 89.99, 90.0})
    for (const double aerosol : {0.0, 10.0})
      for (const double angstrom : {-1.0, 4.0})
        for (const double water : {0.0, 20.0})
          for (const double pressure : {0.0, 120000.0})
            for (const double albedo : {0.0, 1.0}) {
              const ClearSkyIrradiance e = spectrl2({.sun_zenith_deg = zenith,
                                                     .aerosol = aerosol,
                                                     .angstrom = angstrom,
                                                     .water_cm = water,
                                                     .ozone_atm_cm = 2,
                                                     .pressure_Pa = pressure,
                                                     .albedo = albedo});
              for (size_t i = 0; i < e.nm.size(); ++i) {
                EXPECT_TRUE(std::isfinite(e.direct_normal[i]) && e.direct_normal[i] >= 0) << zenith << ' ' << aerosol;
                EXPECT_TRUE(std::isfinite(e.diffuse[i]) && e.diffuse[i] >= 0) << zenith << ' ' << aerosol;
                EXPECT_LE(e.direct_normal[i], e.extraterrestrial[i]);
              }
            }
}

}  // namespace
}  // namespace frond
