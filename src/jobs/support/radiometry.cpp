#include "jobs/support/radiometry.h"

#include <fmt/ranges.h>

#include "jobs/support/render_task.h"
#include "system/atomic_file.h"

namespace frond {

void add_band(Table& table, const Band& band) {
  if (!band.name.empty()) table.add("band", band.name);
  table.add("wavelength_nm", band.nm);
}

std::string heading_of(const Band& band) {
  return band.name.empty() ? fmt::format("{:g} nm", band.nm) : "band " + band.name;
}

std::optional<Target> target_of(const Arguments& args) {
  const auto v = args.numbers("target");
  if (v.empty()) return {};
  const Target t{v[0], v[1], v[2], v[3], v[4]};
  if (!(t.x0 < t.x1 && t.y0 < t.y1))
    fail({}, "{} takes x0,x1,y0,y1,z: {} is empty", args.spelled("target"), fmt::join(v, ","));
  return t;
}

std::optional<std::array<double, 2>> period_of(const Arguments& args) {
  const auto v = args.numbers("period");
  return v.empty() ? std::nullopt : std::optional(std::array{v[0], v[1]});
}

/// The same file serves as checkpoint and as complete result, because the result proper is the CSV file.
std::optional<ResumeFile::Names> kept_names_of(const Arguments& args) {
  if (args.given("part")) return ResumeFile::Names{args.text("part"), args.text("part") + ".checkpoint"};
  for (const char* name : {"checkpoint", "resume"})
    if (args.given(name) && !args.given("csv"))
      fail({}, "{} needs {} or {}", args.spelled(name), args.spelled("csv"), args.spelled("part"));
  if (!args.given("checkpoint") && !args.flag("resume")) return {};
  if (args.text("csv") == "-")
    fail({}, "{} and {} save a file beside the file of {}, which cannot be standard output", args.spelled("checkpoint"),
         args.spelled("resume"), args.spelled("csv"));
  const std::string part = args.text("csv") + ".part";
  check_replaceable(part);
  return ResumeFile::Names{part, part};
}

SampleRange path_range_of(const Arguments& args, uint64_t block, uint64_t total) {
  if (!args.given("samples")) return {0, total};
  const SampleRange range = sample_range_of(args, "paths");
  return {range.begin - range.begin % block,
          range.end < uint64_t(args.count("paths")) ? range.end - range.end % block : total};
}

void warn_of_time_limit(const JobRun& run, uint64_t paths, double error) {
  const Arguments& args = run.args;
  if (const double rms = args.real("rms"); rms > 0) {
    if (error > rms) run.log().warn({}, fmt::format("{} {:g} was not reached", args.spelled("rms"), rms));
  } else if (const auto asked = uint64_t(args.count("paths")); paths < asked) {
    run.log().warn({}, fmt::format("the time limit ended: {} paths were traced, not {}", paths, asked));
  }
}

}  // namespace frond
