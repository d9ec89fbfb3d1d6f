#include <fmt/format.h>

#include <numbers>

#include "report/conform_report.h"
#include "report/polar_map.h"

namespace frond {
namespace {

// A diverging palette that is readable with any colour vision: ColorBrewer's RdBu.
constexpr std::array kRatioColors{0x2166ac, 0x67a9cf, 0xf7f7f7, 0xef8a62, 0xb2182b};

/// Returns the value that a patch shows: found / expected, or found if nothing is expected.
double value_of(const SphereMap& map, const SphereMap::Patch& p) {
  return map.expected.empty() ? p.found : p.found / p.expected;
}

/// Returns a scale symmetric in the logarithm of the ratio, up to a round limit; for found values, a scale from 0.
ColorScale scale_of(const SphereMap& map) {
  constexpr std::array kLimits{1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0};
  Range all{0, 0};
  const bool is_ratio = !map.expected.empty();
  for (const auto& p : map.patches) all.include(is_ratio ? std::abs(std::log(value_of(map, p))) : p.found);
  if (!is_ratio) return {{map.found, {0, all.high > 0 ? all.high : 1}}};
  const auto enough = std::ranges::find_if(kLimits, [&](double x) { return std::log(x) >= all.high; });
  const double most = enough == kLimits.end() ? kLimits.back() : *enough, least = 1 / most;
  std::vector<Tick> ticks{{least, fmt::format("≤ {:.3g}", least)}, {1, "1"}, {most, fmt::format("≥ {:.3g}", most)}};
  if (most > 4) ticks.insert(ticks.end(), {{0.5, "0.5"}, {2, "2"}});
  return {{fmt::format("{}, over {}", map.found, map.expected), {least, most}, true, 0, ticks}, kRatioColors};
}

/// Radius in Lambert's equal-area projection of a hemisphere, with the pole in the centre. The back is seen through the
/// front.
double radius_of(double cos_theta) { return std::sqrt(std::max(0.0, 1 - std::abs(cos_theta))); }

/// Returns the finding in lines that fit the chart.
std::vector<std::string> captions_of(const Finding& finding) {
  constexpr size_t kMost = 92;  // characters
  std::vector<std::string> lines{finding.where};
  for (std::string rest = finding.message; !rest.empty();) {
    const size_t end = rest.size() <= kMost ? rest.size() : std::min(rest.rfind(' ', kMost), rest.size());
    lines.push_back(rest.substr(0, end));
    rest.erase(0, std::min(rest.size(), end + 1));
  }
  return lines;
}

}  // namespace

Chart sphere_chart(const Finding& finding) {
  const SphereMap& map = *finding.map;
  const ColorScale scale = scale_of(map);
  Panel panel{640, 366, " ", {"", {-2.2, 2.2}}, {"", {-1.1, 1.25}}, true};
  const PolarMap front{panel, -1.12}, back{panel, 1.12};
  for (const auto& p : map.patches) {
    const auto [inner, outer] = std::minmax({radius_of(p.box.z0), radius_of(p.box.z1)});
    const PolarMap& disk = p.box.z0 + p.box.z1 > 0 ? front : back;
    disk.add_patch({inner, outer}, {p.box.phi0, p.box.phi1}, scale.color(value_of(map, p)));
  }
  for (const PolarMap& disk : {front, back}) {
    disk.add_circles({radius_of(std::sqrt(0.75)), radius_of(0.5), 1});
    const char* side = disk.center_x < 0 ? "light directions wi on the front" : "on the back, seen through the front";
    panel.series.push_back({"", "", 0, {}, Mark::none, 0, {{disk.center_x, 1.14}}, side});
  }
  const PolarMap& seen = map.wo.z > 0 ? front : back;
  const ChartPoint wo = seen.at(radius_of(double(map.wo.z)), std::atan2(double(map.wo.y), double(map.wo.x)));
  seen.add_mark(wo, Mark::disk, "");
  panel.series.push_back({"", "", 0, {}, Mark::none, 0, {{wo.x, wo.y - 0.15}}, "wo"});
  const std::string verdict = finding.passed ? " holds (the largest deviation)" : " is broken";
  return {2, {panel, scale.panel(panel.height)}, std::string(law_name(finding.law)) + verdict, captions_of(finding)};
}

}  // namespace frond
