#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/units/interval.h"

namespace frond {

/// Physical quantity of a number that is often given in another unit than the parameter's.
enum class PhysicalQuantity : uint8_t {
  other,           ///< values in its range say nothing about their unit
  angle,           ///< degrees
  sweep,           ///< degrees, up to a turn
  air_pressure,    ///< Pa
  water_vapour,    ///< precipitable water, cm
  ozone,           ///< atm-cm
  soil_moisture,   ///< percent of the volume
  leaf_thickness,  ///< m
  chlorophyll,     ///< kg/m^3
  carotenoids,     ///< kg/m^3
  anthocyanins,    ///< kg/m^3
  dry_matter,      ///< kg/m^3, all of it or a constituent
  brown_pigments,  ///< 1/m
  absorption,      ///< of a leaf's tissue, 1/m
};

/// Returns a hint if a number is probably in another common unit than the parameter's, such as "if it is in hPa, write
/// 101325"; "" otherwise. There is no hint for 0 and for whole degrees. Numbers outside the range are also tried as
/// percent of a share and as micrometres instead of nm.
std::string unit_hint(double value, PhysicalQuantity quantity, std::string_view unit, const Interval& range);

}  // namespace frond
