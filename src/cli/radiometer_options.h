#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/kept_file.h"
#include "cli/reading_options.h"
#include "radiometry/brf.h"

namespace CLI {
class App;
}

namespace frond {

/// What both virtual radiometers are told on the command line.
struct RadiometerOptions {
  std::string scene, wavelengths = "450,550,670,800", paths = "65536", integrator, csv, cache;
  std::vector<double> target, period;
  std::vector<std::string> swaps, plugins;
  std::optional<uint64_t> seed;
  double rms = 0, time_limit_seconds = 0, checkpoint_seconds = 0;
  int threads = 0;
  ReadingOptions reading;
  bool no_cache = false, quiet = false, resume = false;
};

/// Declares them; they are read into `options`, which must outlive the command. `paths`: what --paths is of.
void add_radiometer_options(CLI::App& command, RadiometerOptions& options, const std::string& paths);

/// Wavelengths alone are those of `bands`. Throws InputError.
std::string wavelengths_of(const RadiometerOptions& options);
std::optional<Target> target_of(const RadiometerOptions& options);
std::optional<std::array<double, 2>> period_of(const RadiometerOptions& options);
/// What is measured, with the overrides in it. Throws InputError.
SceneDescription scene_of(const RadiometerOptions& options, const Session& session);
SessionOptions session_options_of(const RadiometerOptions& options);
/// The file beside that of --csv that checkpoints are kept in; empty where none are asked for.
std::unique_ptr<KeptFile> kept_file_of(const RadiometerOptions& options, const Log& log);

}  // namespace frond
