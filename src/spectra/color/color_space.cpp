#include "spectra/color/color_space.h"

#include <algorithm>

namespace frond {
namespace {

/// White of ACES (SMPTE ST 2065-1).
constexpr Chromaticity kAcesWhite{0.32168, 0.33767};
/// The primaries of XYZ itself, with the equal-energy white.
constexpr Chromaticities kXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

ColorSpace make(std::string_view name, std::string_view linear_name, const Chromaticities& c) {
  const Matrix3 own = xyz_from_rgb(c);
  const bool adapt = c.white.x != kD65White.x || c.white.y != kD65White.y;
  const Matrix3 to_d65 = adapt ? bradford(c.white.xyz(), kD65White.xyz()) * own : own;
  return {name, linear_name, c, to_d65, inverse(to_d65)};
}

// Chromaticities: IEC 61966-2-1, SMPTE RP 145, ITU-R BT.2020, SMPTE RP 431-2 with D65, SMPTE ST 2065-1, AMPAS
// S-2014-004.
const std::array<ColorSpace, 6>& table() {
  static const std::array<ColorSpace, 6> spaces{
      make("srgb", "linear sRGB", {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65White}),
      make("smpte-c", "linear SMPTE-C", {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, kD65White}),
      make("rec2020", "linear Rec.2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65White}),
      make("dci-p3", "linear P3-D65", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65White}),
      make("aces2065-1", "ACES2065-1", {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, kAcesWhite}),
      make("acescg", "ACEScg", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, kAcesWhite}),
  };
  return spaces;
}

}  // namespace

Matrix3 xyz_from_rgb(const Chromaticities& c) {
  Matrix3 primaries;
  size_t column = 0;
  for (const Chromaticity& p : {c.red, c.green, c.blue}) {
    primaries.row[0][column] = p.x;
    primaries.row[1][column] = p.y;
    primaries.row[2][column++] = 1 - p.x - p.y;
  }
  return primaries * Matrix3::diagonal(inverse(primaries) * c.white.xyz());
}

Matrix3 bradford(const Triple& from_white, const Triple& to_white) {
  constexpr Matrix3 kCones{{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};
  const Triple from = kCones * from_white, to = kCones * to_white;
  return inverse(kCones) * Matrix3::diagonal({to[0] / from[0], to[1] / from[1], to[2] / from[2]}) * kCones;
}

std::span<const ColorSpace> color_spaces() { return table(); }

const ColorSpace* find_color_space(std::string_view name) {
  const auto& spaces = table();
  const auto it = std::find_if(spaces.begin(), spaces.end(),
                               [name](const ColorSpace& s) { return s.name == name || s.linear_name == name; });
  return it == spaces.end() ? nullptr : &*it;
}

const ColorSpace& color_space(std::string_view name, const Location& where) {
  if (const ColorSpace* space = find_color_space(name)) return *space;
  fail(where, "unknown color space \"{}\"{}", name, suggestion(name, color_space_names()));
}

std::vector<std::string_view> color_space_names() {
  std::vector<std::string_view> names;
  for (const ColorSpace& s : table()) names.push_back(s.name);
  return names;
}

const Chromaticities* chromaticities_of(std::string_view linear_name) {
  if (linear_name == kXyzName) return &kXyz;
  const ColorSpace* space = find_color_space(linear_name);
  return space ? &space->chromaticities : nullptr;
}

}  // namespace frond
