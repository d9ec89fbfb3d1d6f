#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/record/job.h"
#include "render/image_output.h"
#include "study/choose/choice.h"

namespace frond {

/// A render as the arguments of the job `render` ask for it: reading, the choice of models, loading, rendering. What
/// becomes of the film is the caller's.
class RenderTask {
 public:
  /// `run` must outlive it. `adaptive`: its films know their noise, whether --max-rms is given or not.
  explicit RenderTask(const JobRun& run, bool adaptive = false)
      : run_(run), is_adaptive_(adaptive || run.args.given("max-rms")) {}

  /// A scene that may be in several files. Throws all that is wrong with it.
  void read(const std::vector<std::filesystem::path>& files);
  /// A scene that is a string; errors call it `name`, and files that it names are found from there.
  void read_text(const std::string& text, const std::string& name);
  /// File that the scene's film names.
  const std::string& film_file() const { return film_file_; }

  /// Chooses the models of open leaves. `output`, which may be nullptr, is to hold the image: what it cannot hold is
  /// refused first.
  void choose(const ImageOutput* output);
  /// The choice of models; empty where no leaf is open.
  const std::optional<choose::Choice>& choice() const { return choice_; }
  /// Builds the scene. Throws InputError.
  void load(const ImageOutput* output);

  const LoadedScene& scene() const { return *scene_; }
  SampleRange samples() const { return samples_; }  ///< of each pixel
  bool is_adaptive() const { return is_adaptive_; }
  /// A part without samples.
  RenderPart empty_part() const;
  /// Renders what the part lacks of the samples that are asked for. `plan_changed` may be empty.
  RenderStatistics render(RenderPart& part, const RenderControl& control,
                          const std::function<void(const PartHeader&)>& plan_changed = {}) const;

 private:
  void apply_arguments();

  const JobRun& run_;
  bool is_adaptive_;
  SceneDescription description_;
  std::string film_file_;
  ImageRequest request_;
  std::optional<choose::Choice> choice_;
  std::shared_ptr<const Scene> pilot_;  ///< shares its geometry
  std::optional<LoadedScene> scene_;
  SampleRange samples_;
};

extern const JobInfo kRenderJob;

}  // namespace frond
