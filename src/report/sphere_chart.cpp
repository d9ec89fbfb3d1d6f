#include "report/sphere_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "report/gnuplot.h"

namespace frond {
namespace {

using Rgb = std::array<double, 3>;

// Ends and middle are told apart whatever colours one sees: after ColorBrewer's RdBu, and viridis.
constexpr Rgb kRatioColors[] = {{33, 102, 172}, {103, 169, 207}, {247, 247, 247}, {239, 138, 98}, {178, 24, 43}};
constexpr Rgb kAmountColors[] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
constexpr std::string_view kNothing = "#c0c0c0";

/// At t in [0, 1] of the way through evenly spaced colours.
std::string color_at(std::span<const Rgb> colors, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
  const size_t i = std::min(static_cast<size_t>(place), colors.size() - 2);
  std::array<int, 3> c{};
  for (size_t k = 0; k < 3; ++k)
    c[k] = static_cast<int>(std::lround(std::lerp(colors[i][k], colors[i + 1][k], place - static_cast<double>(i))));
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

/// The colour scale of a map: from a patch's numbers to [0, 1], and what stands beside the key.
class Scale {
 public:
  explicit Scale(const SphereMap& map) : is_ratio_(!map.expected.empty()) {
    double extreme = 0;
    for (const SphereMap::Patch& p : map.patches) extreme = std::max(extreme, size_of(p));
    if (is_ratio_) {
      constexpr std::array kLimits{1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0};
      const auto limit = std::ranges::find_if(kLimits, [&](double x) { return std::log(x) >= extreme; });
      limit_ = limit == kLimits.end() ? kLimits.back() : *limit;
    } else if (extreme > 0) {
      limit_ = extreme;
    }
    title_ = is_ratio_ ? fmt::format("{}, over {}", map.found, map.expected) : map.found;
  }

  /// Nothing where there is nothing to compare.
  std::optional<double> place(const SphereMap::Patch& p) const {
    if (!is_ratio_) return p.found / limit_;
    if (!(p.expected > 0) && !(p.found > 0)) return {};
    return 0.5 + std::log(p.found / p.expected) / (2 * std::log(limit_));
  }
  std::string color(std::optional<double> place) const {
    if (!place) return std::string(kNothing);
    return color_at(is_ratio_ ? std::span(kRatioColors) : std::span(kAmountColors), *place);
  }
  std::array<std::string, 3> ticks() const {
    if (is_ratio_) return {fmt::format("{:.3g} or less", 1 / limit_), "1", fmt::format("{:.3g} or more", limit_)};
    return {"0", fmt::format("{:.3g}", limit_ / 2), fmt::format("{:.3g}", limit_)};
  }
  const std::string& title() const { return title_; }

 private:
  /// How far from the scale's neutral point; infinities do not stretch the scale.
  double size_of(const SphereMap::Patch& p) const {
    const double x = is_ratio_ ? std::abs(std::log(p.found / p.expected)) : p.found;
    return std::isfinite(x) ? x : 0;
  }

  bool is_ratio_;
  double limit_ = 1;
  std::string title_;
};

constexpr double kDiskAt = 1.12;  // centres lie at -kDiskAt and +kDiskAt, radii are 1

/// Lambert's equal-area projection of a hemisphere, the pole in the middle; the back is seen through the front.
double radius_of(double cos_theta) { return std::sqrt(std::max(0.0, 1 - std::abs(cos_theta))); }

std::string point(bool front, double radius, double phi) {
  return fmt::format("{:.4f},{:.4f}", (front ? -kDiskAt : kDiskAt) + radius * std::cos(phi), radius * std::sin(phi));
}

std::string patch(const SphereBox& box, const std::string& color) {
  constexpr double kStep = std::numbers::pi / 60;
  const bool front = box.z0 + box.z1 > 0;
  const int steps = std::max(1, static_cast<int>(std::ceil((box.phi1 - box.phi0) / kStep)));
  std::string corners;
  const auto arc = [&](double radius, double from, double to) {
    for (int i = 0; i <= steps; ++i)
      corners += (corners.empty() ? "" : " to ") + point(front, radius, std::lerp(from, to, double(i) / steps));
  };
  arc(radius_of(box.z0), box.phi0, box.phi1);
  arc(radius_of(box.z1), box.phi1, box.phi0);
  corners += " to " + point(front, radius_of(box.z0), box.phi0);
  return fmt::format("set object polygon from {} fillstyle solid noborder fillcolor rgb '{}'\n", corners, color);
}

std::string circles() {
  std::string text;
  for (const bool front : {true, false})
    for (const double theta_deg : {30., 60., 90.}) {
      const double radius = radius_of(std::cos(theta_deg * std::numbers::pi / 180));
      text +=
          fmt::format("set object circle at {} size {:.4f} front fillstyle empty border lc rgb '#{}' lw {}\n",
                      point(front, 0, 0), radius, theta_deg == 90 ? "000000" : "909090", theta_deg == 90 ? 1.2 : 0.5);
      text += fmt::format("set label '{} deg' at {} center front font ',8'\n", theta_deg,
                          point(front, radius + 0.045, -std::numbers::pi / 2));
    }
  return text;
}

std::string mark(const Vec3& wo) {
  const double phi = std::atan2(double(wo.y), double(wo.x)), radius = radius_of(double(wo.z));
  return fmt::format(
      "set object circle at {0} size 0.032 front fillstyle solid noborder fillcolor rgb 'white'\n"
      "set object circle at {0} size 0.022 front fillstyle solid noborder fillcolor rgb 'black'\n"
      "set label 'wo' at {0} front offset char 1,0.6\n",
      point(wo.z > 0, radius, phi));
}

std::string key(const Scale& scale) {
  constexpr int kSteps = 100;
  constexpr double kLeft = -1, kWidth = 2, kBottom = -1.42, kTop = -1.34;
  std::string text;
  for (int i = 0; i < kSteps; ++i)  // each to the right end: side by side they would show seams
    text += fmt::format("set object rectangle from {:.4f},{} to {},{} fillstyle solid noborder fillcolor rgb '{}'\n",
                        kLeft + kWidth * i / kSteps, kBottom, kLeft + kWidth, kTop, scale.color((i + 0.5) / kSteps));
  const auto ticks = scale.ticks();
  for (size_t i = 0; i < ticks.size(); ++i)
    text += fmt::format("set label {} at {},{} center\n", gnuplot_text(ticks[i]), kLeft + kWidth * double(i) / 2,
                        kBottom - 0.07);
  return text + fmt::format("set label {} at 0,{} center\n", gnuplot_text(scale.title()), kTop + 0.07);
}

}  // namespace

std::string sphere_chart(const Finding& finding) {
  const SphereMap& map = *finding.map;
  const Scale scale(map);
  std::string script = "unset border\nunset tics\nunset key\nset size ratio -1\nset margins 0,0,0,0\n";
  script += "set xrange [-2.3:2.3]\nset yrange [-1.6:1.6]\n";
  const std::string verdict = finding.passed ? "holds (the largest deviation)" : "is broken";
  script += fmt::format("set label {} at 0,1.5 center font ',14'\n",
                        gnuplot_text(fmt::format("{} {}", law_name(finding.law), verdict)));
  script += fmt::format("set label {} at 0,1.38 center font ',9'\n", gnuplot_text(finding.where));
  script += fmt::format("set label {} at 0,1.28 center font ',9'\n", gnuplot_text(finding.message));
  for (const SphereMap::Patch& p : map.patches) script += patch(p.box, scale.color(scale.place(p)));
  script += circles() + mark(map.wo) + key(scale);
  script += fmt::format(
      "set label 'wi on the front' at {},1.08 center\nset label 'wi on the back, seen through the front' at {},1.08 "
      "center\n",
      -kDiskAt, kDiskAt);
  return script + "plot NaN\n";
}

}  // namespace frond
