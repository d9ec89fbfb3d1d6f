#pragma once

#include <array>

#include "jobs/record/common_params.h"
#include "jobs/support/resume_file.h"
#include "radiometry/brf.h"
#include "render/film/work.h"
#include "report/table.h"

/// Parameters shared by the jobs brf and flux: the measurement in a scene, and checkpoints beside the CSV file.
namespace frond {

inline constexpr JobParam kRadiometryWavelengthsParam(
    "wavelengths", ArgumentKind::text, "Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=...",
    {.type = "WAVELENGTHS", .default_value = "450,550,670,800", .unit = "nm", .decides = true});
inline constexpr JobParam kTargetParam(
    "target", ArgumentKind::numbers,
    "x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.",
    {.type = "X0,X1,Y0,Y1,Z", .values = 5, .decides = true});
inline constexpr JobParam kPeriodParam("period", ArgumentKind::numbers,
                                       "Lengths along x and y after which the scene is repeated periodically.",
                                       {.type = "X,Y", .range = kAboveZero, .values = 2, .decides = true});
constexpr JobParam rms_param(std::string_view doc) {
  return JobParam("rms", ArgumentKind::real, doc, {.range = {kAboveZero.min, 1}});
}
inline constexpr JobParam kCheckpointParam("checkpoint", ArgumentKind::real,
                                           "Keep the partial result in CSV.part at this interval, and when stopped by "
                                           "SIGINT, SIGTERM or SIGHUP; with --part in "
                                           "FILE.checkpoint.",
                                           {.unit = "s", .range = kAboveZero});
inline constexpr JobParam kResumeParam("resume", ArgumentKind::flag,
                                       "Resume from CSV.part, or the file of --part, if it exists; write one too.");
constexpr JobParam part_param(std::string_view excludes) {
  return JobParam("part", ArgumentKind::text,
                  "Write the sums over the paths of --samples instead of a result, to be combined with --merge.",
                  {.type = "FILE", .path = PathUse::write, .excludes = excludes});
}
inline constexpr JobParam kPathRangeParam(
    "samples", ArgumentKind::text,
    "Range of the paths to measure, without END, as in 0:500000. Both ends are rounded down to whole blocks of paths.",
    {.type = "FIRST:END", .needs = "part"});
constexpr JobParam merge_param(std::string_view excludes) {
  return JobParam("merge", ArgumentKind::texts,
                  "Part of this measurement, written by --part: return the result of all parts. The other options must "
                  "be those of the parts.",
                  {.type = "FILE", .path = PathUse::read, .excludes = excludes});
}

/// Appends what identifies a band in a row of data: its name, if it has one, and its wavelength.
void add_band(Table& table, const Band& band);
/// Returns the heading of a band's column in text: "550 nm", or "band nir".
std::string heading_of(const Band& band);
/// Returns --target, or nullopt for the default.
std::optional<Target> target_of(const Arguments& args);
/// Returns --period in scene units, or nullopt.
std::optional<std::array<double, 2>> period_of(const Arguments& args);
/// Warns if the time limit ended a measurement before --paths, or before its standard error was as small as --rms.
void warn_of_time_limit(const JobRun& run, uint64_t paths, double error);
/// Returns the range of --samples, or all paths. Both ends are multiples of `block`, except the end of all paths,
/// `total`: --paths, or more if the measurement needs them.
SampleRange path_range_of(const Arguments& args, uint64_t block, uint64_t total);
/// Returns the names of --part and its checkpoint, or of the partial result beside --csv; nullopt if none of --part,
/// --checkpoint and --resume is given.
std::optional<ResumeFile::Names> kept_names_of(const Arguments& args);

}  // namespace frond
