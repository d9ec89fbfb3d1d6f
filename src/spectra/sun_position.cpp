#include "spectra/sun_position.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/math/vec.h"

namespace frond {
namespace {

constexpr double kDay = 86400;  // s

/// Reads digits from the front of a text; nullopt if there are fewer than `count`.
std::optional<int> take_digits(std::string_view& text, size_t count) {
  if (text.size() < count) return {};
  int value = 0;
  for (size_t i = 0; i < count; ++i) {
    if (text[i] < '0' || text[i] > '9') return {};
    value = 10 * value + (text[i] - '0');
  }
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// Reads "Z", "+02:00", "+0200" or "+02", or nothing. Returns false for other text.
bool take_offset(std::string_view text, std::optional<double>& offset) {
  if (text.empty()) return true;
  if (text == "Z" || text == "z" || text == "UTC" || text == " UTC") {
    offset = 0;
    return true;
  }
  const double sign = text[0] == '-' ? -1 : 1;
  if (!take(text, "+-")) return false;
  const auto hours = take_digits(text, 2);
  if (!hours) return false;
  (void)take(text, ":");
  const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
  if (!minutes || !text.empty()) return false;
  offset = sign * (*hours * 3600 + *minutes * 60);
  return true;
}

/// Elevation above the horizon in the air, from that without air, degrees (Michalsky 1988).
double refracted(double elevation) {
  constexpr double kLowest = -0.56;
  if (elevation < kLowest) return elevation + 0.56;
  const double e = elevation;
  return std::min(90.0, e + 3.51561 * (0.1594 + 0.0196 * e + 0.00002 * e * e) / (1 + 0.505 * e + 0.0845 * e * e));
}

}  // namespace

double CivilTime::days_since_2000() const {
  using namespace std::chrono;
  const sys_days date{std::chrono::year(year) / month / day}, epoch{std::chrono::year(2000) / 1 / 1};
  return double((date - epoch).count()) - 0.5 + seconds / kDay;
}

int CivilTime::day_of_year() const {
  using namespace std::chrono;
  return int((sys_days{std::chrono::year(year) / month / day} - sys_days{std::chrono::year(year) / 1 / 1}).count()) + 1;
}

std::optional<CivilTime> parse_time(std::string_view text) {
  const auto year = take_digits(text, 4);
  if (!year || !take(text, "-")) return {};
  const auto month = take_digits(text, 2);
  if (!month || !take(text, "-")) return {};
  const auto day = take_digits(text, 2);
  if (!day || !(std::chrono::year(*year) / *month / *day).ok()) return {};
  CivilTime time{*year, *month, *day, 0, {}};
  if (text.empty()) return time;
  if (!take(text, "T ")) return {};
  const auto hour = take_digits(text, 2);
  if (!hour || *hour > 24 || !take(text, ":")) return {};
  const auto minute = take_digits(text, 2);
  if (!minute || *minute > 59) return {};
  time.seconds = *hour * 3600 + *minute * 60;
  if (take(text, ":")) {
    const std::string rest(text);
    char* end = nullptr;
    const double seconds = std::strtod(rest.c_str(), &end);
    if (rest.empty() || rest[0] < '0' || rest[0] > '9' || !(seconds < 61)) return {};
    time.seconds += seconds;
    text.remove_prefix(size_t(end - rest.c_str()));
  }
  return take_offset(text, time.offset_seconds) ? std::optional(time) : std::nullopt;
}

SunPosition sun_position(double days, double latitude, double longitude) {
  const double mean_longitude = 280.460 + 0.9856474 * days, anomaly = (357.528 + 0.9856003 * days) * kDegree;
  const double ecliptic = (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 0.0000004 * days) * kDegree;
  const double ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
  // Mean sidereal time; a day of 24 h UTC is 24.0657098242 h of it.
  const double sidereal_hours = 18.697374558 + 24.06570982441908 * days;
  const double hour_angle = (15 * std::fmod(sidereal_hours, 24.0) + longitude) * kDegree - ascension;
  const double phi = latitude * kDegree;
  const double sine =
      std::sin(declination) * std::sin(phi) + std::cos(declination) * std::cos(phi) * std::cos(hour_angle);
  const double azimuth =
      std::atan2(-std::cos(declination) * std::sin(hour_angle),
                 std::sin(declination) * std::cos(phi) - std::cos(declination) * std::sin(phi) * std::cos(hour_angle)) /
      kDegree;
  return {refracted(std::asin(std::min(1.0, std::max(-1.0, sine))) / kDegree), azimuth < 0 ? azimuth + 360 : azimuth};
}

}  // namespace frond
