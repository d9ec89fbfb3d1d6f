#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/parallel.h"
#include "render/parts/part.h"
#include "render/render_loop.h"
#include "scene/overrides.h"
#include "scene/read_scene.h"
#include "scene/scene.h"

namespace frond {

/// Settings of an image in addition to those of the scene.
struct ImageRequest {
  std::optional<Crop> pixels = {};  ///< pixels to render; in pixels of the film, which --quick halves
  /// True if other parts, to be merged with this one, contain the other pixels of the scene's crop. It matters with
  /// splatting only: true takes samples of `pixels` and of the margin around the scene's crop, false takes samples of
  /// all pixels within the filter's reach of `pixels`.
  bool is_part = false;
  std::vector<std::string> channels = {};  ///< channels in addition to those of the scene's film (channels.h)
  std::string color_space = {};  ///< linear name, if the scene states none; empty: that of the wavelength strategy
  std::map<std::string, std::string> attributes = {};  ///< attributes for the header of the image file
  bool adaptive = false;     ///< estimate noise from halves of the samples, as Session::render_to requires
  std::string command = {};  ///< command line without samples and pixels, for the file header and the identity
};

/// A scene that is ready to render, with the formats of its film and its image.
class LoadedScene {
 public:
  const Scene& scene() const { return *scene_; }
  const SceneDescription& description() const { return description_; }
  const FilmFormat& film_format() const { return facts_.format; }
  const ImageFormat& image_format() const { return image_format_; }
  /// Samples per pixel that the scene file states.
  uint64_t samples() const { return uint64_t(scene_->samples_per_pixel()); }
  /// Throws InputError if `samples` per pixel are too few to sample each spectral band at least once, or too many.
  void check_samples(uint64_t samples) const;
  /// Arguments for `render`; they refer to this object.
  RenderInputs job() const;
  /// Identity of the image. Reads every file that the scene names; throws InputError.
  Identity identity() const { return identity_of(description_, facts_); }
  /// Part without samples. Throws InputError if the film needs more memory than the machine has.
  RenderPart empty_part() const;

 private:
  friend class Session;

  SceneDescription description_;
  IdentityInputs facts_;
  std::unique_ptr<Scene> scene_;
  Crop scene_crop_{};
  ImageFormat image_format_;
};

/// Noise target of an adaptive render.
struct NoiseRequest {
  double max_rms = 0;                ///< RMS of the noise over pixels and colours, in film units
  bool is_relative = false;          ///< in units of each colour's mean over the image instead
  uint64_t most_samples = 1u << 30;  ///< upper limit of samples per pixel
  /// Called when the plan changes; may be empty. Must call its first argument, which changes the part's header and
  /// film; no checkpoint may be written meanwhile. The second argument is the header, for the checkpoints that follow.
  std::function<void(const std::function<void()>& change, const PartHeader&)> on_change = {};
};

/// Options of a session.
struct SessionOptions {
  int threads = 0;                        ///< 0: one for each hardware thread
  std::filesystem::path cache = {};       ///< folder for tables that materials compute; empty: none are stored
  std::vector<std::string> plugins = {};  ///< shared objects, in addition to those of FROND_PLUGIN_PATH
};

/// Returns a material as messages name it.
std::string name_in_messages(const MaterialDescription& material);

/// Plug-ins, threads, cache and log that renders share. It is the entry point of the library for programs that render:
///
///   Session session(log);
///   const LoadedScene scene = session.load(session.read("scene.pbrt"));
///   RenderPart part = scene.empty_part();
///   session.render(scene, SampleRange{0, 64}, part);
///   const Image image = film_image(part.film, part.header.image);
///
/// All functions throw InputError for errors in the input. One thread at a time may use a session.
class Session {
 public:
  /// Loads the plug-ins. `log` must outlive the session.
  explicit Session(const Log& log, SessionOptions options = {});

  const Registry& registry() const { return registry_; }
  /// Registers a material for scenes to use; `info` must outlive the session. Throws InputError if its name is taken.
  void add_material(const MaterialInfo& info);
  const Log& log() const { return log_; }
  ThreadPool& pool() { return pool_; }
  /// Folder for tables that materials compute; empty: none are stored.
  const std::filesystem::path& cache() const { return options_.cache; }
  /// Shared objects that have been loaded.
  std::vector<std::filesystem::path> plugins() const;

  /// Reads a scene file; `-` is standard input.
  SceneDescription read(const std::filesystem::path& path, const Unsupported& unsupported = {}) const;
  /// Reads a scene from a string. Error messages name it `name`, and file names in it are relative to that path.
  SceneDescription read_text(const std::string& text, const std::string& name,
                             const Unsupported& unsupported = {}) const;
  /// Reads a scene from one or more files. Errors are added to `problems`; the result contains all that could be read.
  SceneDescription read(const std::vector<std::filesystem::path>& paths, const Unsupported& unsupported,
                        Problems& problems) const;
  /// Loads all files and makes all objects of a scene without rendering. Throws all errors together.
  void check(const SceneDescription& description);
  /// Film settings of a scene; with --quick, at half the resolution.
  FilmSettings film(const SceneSettings& description) const;
  /// Makes a scene. The description must already contain all overrides (scene/overrides.h). `other` is a scene with the
  /// same geometry, which is then shared, not built again.
  LoadedScene load(SceneDescription description, const ImageRequest& request = {}, const Scene* other = nullptr);

  /// Renders these samples of all pixels of the part, except those that it already contains, and adds them. Returns the
  /// statistics of this call, and adds them to the part's.
  RenderStatistics render(const LoadedScene& scene, SampleRange samples, RenderPart& part,
                          const RenderControl& control = {});
  /// Like `render`, for a rectangle of pixels or for different numbers of samples in each tile.
  RenderStatistics render_plan(const LoadedScene& scene, const WorkPlan& plan, RenderPart& part,
                               const RenderControl& control = {});
  /// Adaptive render: adds samples to the tiles where they reduce the noise most, until its RMS is below the target
  /// with confidence kNoiseConfidence (render/film/adaptive.h), all tiles have the largest number of samples, or
  /// `control` ends it. The scene must be loaded with ImageRequest::adaptive. An interrupted part continues to the same
  /// result. Throws InputError if less than kLeastAdaptive samples are allowed.
  RenderStatistics render_to(const LoadedScene& scene, const NoiseRequest& request, RenderPart& part,
                             const RenderControl& control = {});

 private:
  /// For a handler: rethrows the current exception. That of a plug-in becomes an InputError that names the material at
  /// the hit where it was thrown, if there is one, and the shared objects that are loaded.
  [[noreturn]] void rethrow_naming_material(const std::vector<MaterialDescription>& materials) const;
  LoadedScene load_scene(SceneDescription description, const ImageRequest& request, const Scene* other);

  const Log& log_;
  SessionOptions options_;
  Registry registry_;
  ThreadPool pool_;
};

}  // namespace frond
