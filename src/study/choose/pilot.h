#pragma once

#include <chrono>
#include <map>
#include <optional>

#include "core/log.h"
#include "instruments/errors/convergence.h"
#include "instruments/errors/paired_difference.h"
#include "render/session.h"
#include "spectra/color/color_management.h"
#include "study/choose/open_choice.h"
#include "study/paired_films.h"

namespace frond::choose {

/// The render to select models for.
struct ChoiceTask {
  Session& session;
  SceneDescription& description;  ///< the selected options are written into it
  uint64_t samples;               ///< per pixel of the final render; 0: the scene's number
  const Scene* other = nullptr;   ///< scene with the same geometry, which is then shared; may be nullptr
  bool is_question = false;       ///< the selection is the result: it is made even if it cannot save time
  /// Deadline at which the search ends with the reference; none: no deadline.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
};

/// Samples per pixel of a pilot's first step. Taken one by one, they cost about twice as much.
inline constexpr uint64_t kFirstSamples = 8;

/// Cost of a pilot.
struct PilotCost {
  size_t pixels = 0;
  uint64_t paths = 0;
  double cpu_seconds = 0;  ///< includes the computation of tables
};

/// Renders a sample of the image's pixels with any options of the open choices. All renders share their random numbers,
/// so that equal configurations give equal renders, including noise. Results depend only on the task and its seed.
class Pilot {
 public:
  /// Finds the open choices. Throws InputError.
  Pilot(const ChoiceTask& task, const Ladder& ladder);
  ~Pilot();

  const std::vector<OpenChoice>& open_choices() const { return open_choices_; }
  /// Whether the wavelengths have colours; others cannot be compared.
  bool has_colors() const;
  const FilmSettings& film() const { return film_; }
  /// Returns the scene with the reference options.
  const std::shared_ptr<const Scene>& scene() const { return scene_; }
  /// Returns the samples per pixel of the final render.
  uint64_t scene_samples() const;
  /// Returns the last option of every open choice.
  Configuration reference() const;

  /// Error that the selection may have, in the pilot's unit.
  double request() const { return request_; }
  /// Whether that unit is each channel's mean over the image; otherwise it is linear SMPTE-C.
  bool is_relative() const { return is_relative_; }
  /// Paths traced so far.
  uint64_t paths() const;

  /// Thrown by `render` at the task's deadline.
  struct OutOfTime {};
  /// Renders up to `samples` samples per pixel in each of two renders. Throws OutOfTime.
  void render(const Configuration& answers, uint64_t samples);
  /// Returns the difference of two rendered configurations, in the pilot's unit.
  PairedDifference difference(const Configuration& answers, const Configuration& from) const;
  /// Returns the mean square noise of one render over pixels and channels after kFirstSamples, twice as many, ..., and
  /// after the last. Seconds are 0.
  const std::vector<ConvergencePoint>& noise(const Configuration& answers) const;
  double cpu_us_per_path(const Configuration& answers) const;
  size_t pixels() const { return pixels_.size(); }

  /// Returns the share of pixels whose centre first hits one of the choice's materials.
  double share(const OpenChoice& open_choice) const;
  PilotCost cost() const;

 private:
  struct Render;
  using Halves = std::array<std::vector<float>, 2>;

  Render make(const Configuration& answers);
  /// `render` without a deadline.
  void advance(const Configuration& answers, uint64_t samples);
  const Render& rendered(const Configuration& answers) const;
  Halves images(const Render& render) const;
  void set_unit();

  ChoiceTask task_;
  FilmSettings film_;
  double start_cpu_seconds_;
  SceneDescription variant_;         ///< the task's description without its shapes, with the last configuration
  const Log& quiet_ = silent_log();  ///< the final render reports messages
  SharedWork shared_;
  ColorManager colors_;
  std::shared_ptr<const Scene> scene_;  ///< with the reference wavelengths; other renders share its geometry
  int exponent_ = 0;                    ///< common unit of the films, so that equal leaves give equal bits
  std::vector<OpenChoice> open_choices_;
  std::vector<PixelPosition> pixels_;
  std::map<Configuration, Render> renders_;
  std::array<double, 3> unit_{1, 1, 1};  ///< of each channel, in linear SMPTE-C
  double request_ = 0;
  bool is_relative_ = false;
};

}  // namespace frond::choose
