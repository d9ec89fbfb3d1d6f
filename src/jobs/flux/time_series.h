#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "jobs/record/job.h"
#include "scene/format/description.h"
#include "scene/format/plugin_text.h"

namespace frond {

/// A step of a time series: parameters of a light at one time.
struct TimeStep {
  std::string time = {};                 ///< as the table has it
  double seconds = 0;                    ///< since 2000-01-01 12:00, in UTC if the table states the time zone
  std::string date = {};                 ///< the day of the time, in its own time zone
  bool is_night = false;                 ///< there is no light: sun below the horizon, or no irradiance
  PluginText light = {};                 ///< parameters that replace those of the scene's light
  std::optional<double> elevation = {};  ///< of the sun, degrees, if the table states it
};

/// A light whose parameters change with time.
struct TimeSeries {
  size_t light = 0;  ///< index in SceneDescription::lights
  std::vector<TimeStep> steps;
};

/// Reads --times: a column `time`, the sun's position or the place, irradiances, and parameters of the scene's light by
/// their names. Throws InputError.
TimeSeries read_time_series(const JobRun& run, const SceneDescription& description);

/// Measures a scene at each step by `measure`, and returns the tables of all steps with a column `time`, a table
/// `steps` of single values, and a table `days` of the sums over each day. At night the light is left out; in scenes
/// without other lights such steps are not measured, and their values are 0.
Result measure_times(const JobRun& run, const TimeSeries& series, const SceneDescription& description,
                     const std::function<Result(const SceneDescription&)>& measure);

}  // namespace frond
