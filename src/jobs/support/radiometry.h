#pragma once

#include <array>

#include "jobs/record/common_params.h"
#include "jobs/support/resume_file.h"
#include "radiometry/brf.h"
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
inline constexpr JobParam kCheckpointParam(
    "checkpoint", ArgumentKind::real,
    "Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP.",
    {.unit = "s", .range = kAboveZero, .needs = "csv"});
inline constexpr JobParam kResumeParam("resume", ArgumentKind::flag,
                                       "Resume from CSV.part if it exists; write one too.", {.needs = "csv"});

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
/// Returns the names of the partial result beside --csv; nullopt if neither --checkpoint nor --resume is given.
std::optional<ResumeFile::Names> kept_names_of(const Arguments& args);

}  // namespace frond
