#include "cli/render_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>

#include "study/choose/choice_report.h"

namespace frond {
namespace {

/// Counts by depth, as far as there are any.
std::vector<uint64_t> counts(std::span<const uint64_t> by_depth) {
  while (!by_depth.empty() && by_depth.back() == 0) by_depth = by_depth.first(by_depth.size() - 1);
  return {by_depth.begin(), by_depth.end()};
}

double per_path(double value, const RenderStatistics& s) { return s.paths > 0 ? value / double(s.paths) : 0; }

}  // namespace

void print_report(const RenderReport& r, bool json) {
  const RenderStatistics& s = r.statistics;
  const double us_per_path = per_path(s.cpu_seconds, s) * 1e6, rays_per_path = per_path(double(s.rays), s);
  if (json) {
    nlohmann::ordered_json j{{"output", r.output},
                             {"samples_per_pixel", r.samples.most},
                             {"least_samples_per_pixel", r.samples.least},
                             {"load_seconds", r.load_seconds},
                             {"wall_seconds", s.wall_seconds},
                             {"cpu_seconds", s.cpu_seconds},
                             {"paths", s.paths},
                             {"rays", s.rays},
                             {"cpu_us_per_path", us_per_path},
                             {"rays_per_path", rays_per_path},
                             {"foliar_ratio", r.foliar_ratio},
                             {"variance_in_worst_thousandth", r.error_tail},
                             {"paths_escaped_by_depth", counts(s.ends.escaped)},
                             {"paths_absorbed_by_depth", counts(s.ends.absorbed)}};
    if (r.choice) j["choice"] = nlohmann::ordered_json::parse(choose::choice_json(*r.choice));
    fmt::print("{}\n", j.dump(2));
    return;
  }
  const std::string samples = r.samples.least == r.samples.most
                                  ? fmt::format("{}", r.samples.most)
                                  : fmt::format("{} to {}", r.samples.least, r.samples.most);
  fmt::print(stderr,
             "{}: {} samples per pixel in {:.2f} s ({:.2f} s of CPU, {:.3f} us and {:.2f} rays per path), loaded in "
             "{:.2f} s\n",
             r.output, samples, s.wall_seconds, s.cpu_seconds, us_per_path, rays_per_path, r.load_seconds);
  fmt::print(stderr, "foliar ratio {:.2f} %\n", 100 * r.foliar_ratio);
}

}  // namespace frond
