#pragma once

#include <optional>
#include <string_view>

namespace frond {

/// A date and a time of day, as a table of measurements states them.
struct CivilTime {
  int year, month, day;
  double seconds;                        ///< since midnight
  std::optional<double> offset_seconds;  ///< of the time zone, east of UTC above 0; nullopt: not stated

  /// Days since 2000-01-01 12:00 in the time zone of the text.
  double days_since_2000() const;
  /// Returns the number of the day in its year, from 1.
  int day_of_year() const;
};

/// Parses ISO 8601, as "2026-06-21T11:00+02:00" or "2026-06-21 11:00:00"; nullopt for other text and impossible dates.
std::optional<CivilTime> parse_time(std::string_view text);

/// Position of the sun, degrees.
struct SunPosition {
  double elevation;  ///< with the refraction of air at 1010 hPa and 12 degrees Celsius
  double azimuth;    ///< from north to east
};

/// Returns the position of the sun by the low-precision formulas of the Astronomical Almanac (Michalsky 1988): within
/// 0.01 degrees from 1950 to 2050, except for refraction near the horizon. `days`: since 2000-01-01 12:00 UTC.
/// `latitude`, `longitude`: degrees, north and east above 0.
SunPosition sun_position(double days, double latitude, double longitude);

}  // namespace frond
