#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/record/job.h"
#include "render/image_output.h"
#include "study/choose/choice.h"

namespace frond {

/// Parses --samples 64:128, of the samples or paths whose number is the parameter `amount`. Throws InputError.
SampleRange sample_range_of(const Arguments& args, const std::string& amount);

/// A render as described by the arguments of the job `render`: reads the scene, selects leaf models, builds the scene,
/// renders. The caller writes the film.
class RenderTask {
 public:
  /// `run` must outlive this object. `adaptive`: films estimate their noise even if --max-rms is not given.
  explicit RenderTask(const JobRun& run, bool adaptive = false)
      : run_(run), is_adaptive_(adaptive || run.args.given("max-rms")) {}

  /// Reads a scene. Throws Problems with all errors.
  void read(const SceneInput& input);
  /// Reads a scene from a string. Errors name it `name`; relative paths in the scene are resolved against `name`.
  void read_text(const std::string& text, const std::string& name);
  /// Returns the film's file name. Throws InputError, at the film's directive, for one outside of the working folder:
  /// an untrusted scene must not choose which file is replaced.
  const std::string& film_file() const;
  const Location& film_where() const { return film_where_; }

  /// Returns a place for errors of the whole scene: its integrator or film if it names one, else its file.
  const Location& where() const { return where_; }

  /// Selects the models of open leaves; a pilot ends at `deadline`. `output` may be nullptr; otherwise throws
  /// InputError first if the image cannot be written in its format.
  void choose(const ImageOutput* output, std::optional<std::chrono::steady_clock::time_point> deadline);
  /// Returns the selection; empty if the scene has no open leaf.
  const std::optional<choose::Choice>& choice() const { return choice_; }
  /// Builds the scene. Throws InputError.
  void load(const ImageOutput* output);

  const LoadedScene& scene() const { return *scene_; }
  const SceneSettings& settings() const { return settings_; }  ///< as they were read, without overrides
  SampleRange samples() const { return samples_; }             ///< of each pixel
  bool is_adaptive() const { return is_adaptive_; }
  /// Returns a part without samples.
  RenderPart empty_part() const;
  /// Renders the requested samples that the part lacks. `on_change`: as in NoiseRequest.
  RenderStatistics render(RenderPart& part, const RenderControl& control,
                          const decltype(NoiseRequest::on_change)& on_change = {}) const;

 private:
  void apply_arguments();

  const JobRun& run_;
  bool is_adaptive_;
  SceneSettings settings_;
  SceneDescription description_;
  std::string film_file_;
  Location film_where_, where_;
  ImageRequest request_;
  std::optional<choose::Choice> choice_;
  std::shared_ptr<const Scene> pilot_;  ///< shares its geometry with scene_
  std::optional<LoadedScene> scene_;
  SampleRange samples_;
};

extern const JobInfo kRenderJob;

}  // namespace frond
