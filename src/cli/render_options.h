#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/reading_options.h"
#include "image/display_image.h"
#include "render/work.h"
#include "scene/overrides.h"

namespace CLI {
class App;
}

namespace frond {

/// What `frond render` is told.
struct RenderOptions {
  std::vector<std::string> scenes;
  ReadingOptions reading;
  std::string output, part, wavelengths, integrator, filter, cache, range;
  std::vector<double> crop;
  std::vector<int> pixels, pixel;
  std::vector<std::string> swaps, plugins, channels;
  DisplayChoice display;
  std::optional<std::string> display_server;  ///< HOST:PORT
  int samples = 0, threads = 0;
  std::optional<uint64_t> seed;
  double checkpoint_seconds = 0, time_limit_seconds = 0, max_rms = 0;
  bool quick = false, json = false, quiet = false, no_cache = false, pilot = false, resume = false, preview = false;
  bool no_pixel_jitter = false, no_texture_filtering = false, no_wavelength_jitter = false;
  std::vector<std::string> of_pbrt;  ///< its options that do nothing here, as they are spelled
};

/// Declares them; they are read into `options`, which must outlive the command.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Throws InputError for what is no "leaf=abm" or "leaf=abm,mode=analog".
std::vector<MaterialSwap> swaps_of(const std::vector<std::string>& swaps);

/// What of the film the command line asks for; the scene's crop if it says nothing. Ends the wrong way round are put
/// right, with a warning. Throws InputError where that is no pixel.
Crop crop_of(const RenderOptions& options, const FilmSettings& film, const Log& log);

/// What of the command line goes before the scene's options.
void set_scene_options(const RenderOptions& options, SceneDescription& description);

SceneOverrides overrides_of(const RenderOptions& options);

/// Of `--samples 64:128`, where it is given. Throws InputError.
std::optional<SampleRange> range_of(const RenderOptions& options);

/// What of the command decides the pixels, but for their number and that of their samples: threads, paths and what is
/// printed do not belong in a file's header.
std::string command_line_of(const RenderOptions& options, const std::filesystem::path& scene);

}  // namespace frond
