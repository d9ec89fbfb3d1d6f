#include "core/units/quantity.h"

#include <gmock/gmock.h>

namespace frond {
namespace {

using enum PhysicalQuantity;
using ::testing::HasSubstr;

constexpr Interval kAny{-1e30, 1e30};

TEST(PhysicalQuantity, AnotherUnitIsSuggestedWithTheValueToWrite) {
  EXPECT_EQ(unit_hint(1013.25, air_pressure, "Pa", kAny), "if it is in hPa (mbar), write 101325");
  EXPECT_EQ(unit_hint(101.325, air_pressure, "Pa", kAny), "if it is in kPa, write 101325");
  EXPECT_EQ(unit_hint(1, air_pressure, "Pa", kAny), "if it is in atm or bar, write 101325");
  EXPECT_EQ(unit_hint(0.25, soil_moisture, "% of the volume", {0, 55}), "if it is a fraction of 1, write 25");
  EXPECT_EQ(unit_hint(14, water_vapour, "cm", {0, 20}), "if it is in mm or kg/m^2, write 1.4");
  EXPECT_EQ(unit_hint(310, ozone, "atm-cm", {0, 2}), "if it is in Dobson units, write 0.31");
  EXPECT_EQ(unit_hint(0.52, angle, "degrees", {0, 90}), "if it is in radians, write 29.7938");
  EXPECT_EQ(unit_hint(6.2832, sweep, "degrees", {1e-3, 360}), "if it is in radians, write 360");
  EXPECT_EQ(unit_hint(0.2, leaf_thickness, "m", {1e-6, 1e-2}), "if it is in mm, write 0.0002");
  EXPECT_EQ(unit_hint(180, leaf_thickness, "m", {1e-6, 1e-2}), "if it is in um, write 0.00018");
  EXPECT_THAT(unit_hint(40, chlorophyll, "kg/m^3", {0, 100}),
              HasSubstr("if it is in ug/cm2, divide it by thickness x"));
  EXPECT_THAT(unit_hint(8, carotenoids, "kg/m^3", {0, 100}), HasSubstr("ug/cm2"));
  EXPECT_THAT(unit_hint(0.009, dry_matter, "kg/m^3", {0, 1500}), HasSubstr("g/cm2"));
  EXPECT_THAT(unit_hint(0.4, brown_pigments, "1/m", {0, 1e5}), HasSubstr("PROSPECT's content"));
}

TEST(PhysicalQuantity, NumbersOutOfRangeAreTriedAsPercentAndMicrometres) {
  EXPECT_EQ(unit_hint(45, other, "", {0, 1}), "if it is in percent, write 0.45");
  EXPECT_EQ(unit_hint(0.55, other, "nm", {300, 2500}), "if it is in micrometres, write 550");
  EXPECT_EQ(unit_hint(450, other, "", {0, 1}), "");
  EXPECT_EQ(unit_hint(45, other, "K", {0, 1}), "");
}

TEST(PhysicalQuantity, PlausibleNumbersAreNot) {
  for (const auto& [value, quantity, unit] : {std::tuple{101325., air_pressure, "Pa"},
                                              {33000., air_pressure, "Pa"},
                                              {5., soil_moisture, "% of the volume"},
                                              {7., water_vapour, "cm"},
                                              {0.45, ozone, "atm-cm"},
                                              {45., angle, "degrees"},
                                              {1., angle, "degrees"},
                                              {-0.5, angle, "degrees"},
                                              {12., chlorophyll, "kg/m^3"},
                                              {3., carotenoids, "kg/m^3"},
                                              {100., dry_matter, "kg/m^3"},
                                              {200., brown_pigments, "1/m"},
                                              {1.66e-4, leaf_thickness, "m"}})
    EXPECT_EQ(unit_hint(value, quantity, unit, kAny), "") << value << " " << unit;
  for (const PhysicalQuantity q : {angle, air_pressure, soil_moisture, dry_matter, brown_pigments})
    EXPECT_EQ(unit_hint(0, q, "", kAny), "");
}

}  // namespace
}  // namespace frond
