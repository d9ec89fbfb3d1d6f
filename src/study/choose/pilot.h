#pragma once

#include <map>

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
};

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

  /// Renders up to `samples` samples per pixel in each of two renders.
  void render(const Configuration& answers, uint64_t samples);
  /// Returns the difference of two rendered configurations.
  PairedDifference difference(const Configuration& answers, const Configuration& from) const;
  /// Returns the mean square noise of one render over pixels and channels after 1, 2, 4, ... samples and after the
  /// last. Seconds are 0.
  const std::vector<ConvergencePoint>& noise(const Configuration& answers) const;
  double cpu_us_per_path(const Configuration& answers) const;

  /// Returns the share of pixels whose centre first hits one of the choice's materials.
  double share(const OpenChoice& open_choice) const;
  PilotCost cost() const;

 private:
  struct Render;
  using Halves = std::array<std::vector<float>, 2>;

  Render make(const Configuration& answers);
  const Render& rendered(const Configuration& answers) const;
  Halves images(const Render& render) const;

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
};

}  // namespace frond::choose
