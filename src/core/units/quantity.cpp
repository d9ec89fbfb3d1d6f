#include "core/units/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Contents per leaf area, in which the literature and PROSPECT give what a leaf consists of.
constexpr std::string_view kPerArea = "divide it by thickness x mesophyllfraction; 1 ug/cm2 is 1e-5 kg/m^2",
                           kPerAreaInGrams = "divide it by thickness x mesophyllfraction; 1 g/cm2 is 10 kg/m^2",
                           kPerLeaf = "divide it by thickness x mesophyllfraction";

/// Values that are probably in another unit, since the quantity hardly has them in the parameter's.
struct OtherUnit {
  PhysicalQuantity quantity;
  Interval values;
  std::string_view unit;  ///< "in hPa", "a fraction of 1"
  double factor = 0;      ///< converts to the parameter's unit; 0: `conversion` says how
  std::string_view conversion = {};
};

// Limits: a right angle and a turn; the air pressure on Mount Everest is 33 kPa; there are at most 7 cm of water vapour
// in the tropics; 100 ug/cm2 of chlorophyll in a leaf of 0.1 mm are 20 kg/m^3, 20 ug/cm2 of carotenoids are 4 kg/m^3.
constexpr OtherUnit kOtherUnits[] = {
    {PhysicalQuantity::angle, {0, 1.5709}, "in radians", kDegrees},
    {PhysicalQuantity::sweep, {0, 6.2833}, "in radians", kDegrees},
    {PhysicalQuantity::air_pressure, {0, 1.2}, "in atm or bar", 101325},
    {PhysicalQuantity::air_pressure, {20, 120}, "in kPa", 1000},
    {PhysicalQuantity::air_pressure, {120, 1200}, "in hPa (mbar)", 100},
    {PhysicalQuantity::water_vapour, {7.5, 75}, "in mm or kg/m^2", 0.1},
    {PhysicalQuantity::ozone, {10, 1000}, "in Dobson units", 1e-3},
    {PhysicalQuantity::soil_moisture, {0, 1}, "a fraction of 1", 100},
    {PhysicalQuantity::leaf_thickness, {0.02, 5}, "in mm", 1e-3},
    {PhysicalQuantity::leaf_thickness, {10, 5000}, "in um", 1e-6},
    {PhysicalQuantity::chlorophyll, {20, 1000}, "in ug/cm2", 0, kPerArea},
    {PhysicalQuantity::carotenoids, {7, 1000}, "in ug/cm2", 0, kPerArea},
    {PhysicalQuantity::anthocyanins, {15, 1000}, "in ug/cm2", 0, kPerArea},
    {PhysicalQuantity::dry_matter, {0, 0.05}, "in g/cm2", 0, kPerAreaInGrams},
    {PhysicalQuantity::brown_pigments, {0, 0.999}, "PROSPECT's content", 0, kPerLeaf},
    {PhysicalQuantity::absorption, {0, 0.999}, "in 1/mm", 1000},
};

std::string converted(std::string_view unit, double value) {
  return fmt::format("if it is {}, write {:.6g}", unit, value);
}

}  // namespace

std::string unit_hint(double value, PhysicalQuantity quantity, std::string_view unit, const Interval& range) {
  if (value == 0 || !std::isfinite(value)) return "";
  const bool is_whole_degree = unit == "degrees" && value == std::floor(value);
  for (const OtherUnit& other : kOtherUnits) {
    if (other.quantity != quantity || !other.values.contains(value) || is_whole_degree) continue;
    if (other.factor == 0) return fmt::format("if it is {}, {}", other.unit, other.conversion);
    constexpr double kRounding = 1e-4;  // of the number as given: 6.2832 for a turn
    const double in_unit = value * other.factor, nearest = std::clamp(in_unit, range.min, range.max);
    if (std::abs(in_unit - nearest) <= kRounding * std::abs(in_unit)) return converted(other.unit, nearest);
  }
  if (range.contains(value)) return "";
  if (unit.empty() && range.min == 0 && range.max == 1 && range.contains(value / 100))
    return converted("in percent", value / 100);
  if (unit == "nm" && range.contains(value * 1000)) return converted("in micrometres", value * 1000);
  return "";
}

}  // namespace frond
