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

/// A scene as it is to be rendered, but for what it leaves open.
struct ChoiceTask {
  Session& session;
  SceneDescription& description;  ///< the answers are written into it
  uint64_t samples;               ///< a pixel, of the render that the choice is for; 0: the scene's
  const Scene* other = nullptr;   ///< a scene in which the same stands, where there is one: that is not made again
};

/// What a pilot has cost.
struct PilotCost {
  size_t pixels = 0;
  uint64_t paths = 0;
  double cpu_seconds = 0;  ///< tables and all
};

/// Renders some pixels of the image with any answers to the open_choices. All renders share their random numbers: where
/// two do not differ they are the same, noise and all. What they say depends on the task and its seed alone.
class Pilot {
 public:
  /// Also finds the open_choices. Throws InputError.
  Pilot(const ChoiceTask& task, const Ladder& ladder);
  ~Pilot();

  const std::vector<OpenChoice>& open_choices() const { return open_choices_; }
  /// Wavelengths that have no colours cannot be compared.
  bool has_colors() const;
  const FilmSettings& film() const { return film_; }
  /// As it is with what counts as right.
  const std::shared_ptr<const Scene>& scene() const { return scene_; }
  /// A pixel, of the render that the choice is for.
  uint64_t scene_samples() const;
  /// The last option of every open_choice.
  Configuration reference() const;

  /// Up to so many samples a pixel in each of two renders.
  void render(const Configuration& answers, uint64_t samples);
  /// Of two that have been rendered.
  PairedDifference difference(const Configuration& answers, const Configuration& from) const;
  /// Mean square over pixels and channels of one render's noise, after 1, 2, 4 ... samples and the last. Seconds are 0.
  const std::vector<ConvergencePoint>& noise(const Configuration& answers) const;
  double cpu_us_per_path(const Configuration& answers) const;

  /// Share of the pixels whose middle sees one of the open_choice's materials first.
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
  SceneDescription variant_;         ///< the task's without its shapes, as it was rendered last
  const Log& quiet_ = silent_log();  ///< what there is to say the final render says
  SharedWork shared_;
  ColorManager colors_;
  std::shared_ptr<const Scene>
      scene_;         ///< with the wavelengths that count as right; the renders share what stands in it
  int exponent_ = 0;  ///< its films': those of leaves that do not differ have the same bits
  std::vector<OpenChoice> open_choices_;
  std::vector<PixelPosition> pixels_;
  std::map<Configuration, Render> renders_;
};

}  // namespace frond::choose
