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

/// What is said of the image over what the scene says.
struct ImageRequest {
  std::optional<Crop> pixels = {};  ///< of the film, which --quick has halved
  /// The other pixels of the scene's crop are rendered elsewhere, to be merged with these: samples that are shared are
  /// taken of these pixels alone, and of those around the whole. Else of all that reach these pixels, which are then
  /// the whole image's.
  bool is_part = false;
  std::vector<std::string> channels = {};  ///< beside those of the scene's film: names of render/film/channels.h
  std::string color_space = {};  ///< by linear name, where the scene names none; empty: as the wavelengths have it
  std::map<std::string, std::string> attributes = {};  ///< for the image's header
  bool adaptive = false;                               ///< the film is to know its noise, for Session::render_to
  std::string command = {};  ///< what asks for all this, without samples and pixels: for the header, and the identity
};

/// A scene, ready to be rendered, with all that its image is made of.
class LoadedScene {
 public:
  const Scene& scene() const { return *scene_; }
  const SceneDescription& description() const { return description_; }
  /// What a film of it holds.
  const FilmFormat& film_format() const { return facts_.format; }
  const ImageFormat& image_format() const { return image_format_; }
  /// Of each pixel, that the scene asks for.
  uint64_t samples() const { return uint64_t(scene_->samples_per_pixel()); }
  /// Throws InputError where a sensor's bands cannot all be seen in so many samples.
  void check_samples(uint64_t samples) const;
  RenderJob job() const;
  /// All that decides its pixels. Reads every file that the scene names.
  Identity identity() const { return identity_of(description_, facts_); }
  /// A part that nothing has been rendered of.
  RenderPart empty_part() const;

 private:
  friend class Session;

  SceneDescription description_;
  ImageFacts facts_;
  std::unique_ptr<Scene> scene_;
  Crop scene_crop_{};
  ImageFormat image_format_;
};

/// An image whose noise is small enough.
struct NoiseRequest {
  double max_rms = 0;                ///< over pixels and colours, in the film's units
  uint64_t most_samples = 1u << 30;  ///< of a pixel
  /// Is told of each plan, before it is rendered: what is to be kept with checkpoints. May be empty.
  std::function<void(const PartHeader&)> planned = {};
};

struct SessionOptions {
  int threads = 0;                        ///< 0: all
  std::filesystem::path cache = {};       ///< folder of tables that are computed at load; empty: nothing is kept
  std::vector<std::string> plugins = {};  ///< shared objects beside those of FROND_PLUGIN_PATH
};

/// What renders have in common: plug-ins, threads, cache and log. The entry point for programs
/// that render with frond:
///
///   Session session(log);
///   const LoadedScene scene = session.load(session.read("scene.pbrt"));
///   RenderPart part = scene.empty_part();
///   session.render(scene, SampleRange{0, 64}, part);
///   const Image image = film_image(part.film, part.header.image);
///
/// Whatever is wrong with the input is an InputError.
class Session {
 public:
  /// `log` must outlive it.
  explicit Session(const Log& log, SessionOptions options = {});

  const Registry& registry() const { return registry_; }
  /// One more material that scenes can name; `info` must outlive the session. Throws InputError for a name that is
  /// taken.
  void add_material(const MaterialInfo& info);
  const Log& log() const { return log_; }
  ThreadPool& pool() { return pool_; }
  /// Folder of tables that are computed at load; empty: nothing is kept.
  const std::filesystem::path& cache() const { return options_.cache; }
  /// Shared objects that have been loaded.
  std::vector<std::filesystem::path> plugins() const;

  /// A scene file; "-" is standard input.
  SceneDescription read(const std::filesystem::path& path, const Unsupported& unsupported = {}) const;
  /// A scene that stands in a string; `name` is what errors call it, and files that it names are found from there.
  SceneDescription read_text(const std::string& text, const std::string& name,
                             const Unsupported& unsupported = {}) const;
  /// One that may be in several files. What is wrong goes to `problems`, and all that could be read is returned.
  SceneDescription read(const std::vector<std::filesystem::path>& paths, const Unsupported& unsupported,
                        Problems& problems) const;
  /// Loads all that a scene names and renders nothing. Throws all that is wrong.
  void check(const SceneDescription& description);
  /// The film that a scene asks for; half of it where a first look will do.
  FilmSettings film(const SceneSettings& description) const;
  /// The description says all: overrides have been written into it (scene/overrides.h). `other`: a scene in which the
  /// same stands, which is then not made again.
  LoadedScene load(SceneDescription description, const ImageRequest& request = {}, const Scene* other = nullptr);

  /// Adds these samples of all the part's pixels to it, but what it has already. Says what this call took; the part's
  /// own statistics grow by it.
  RenderStatistics render(const LoadedScene& scene, SampleRange samples, RenderPart& part,
                          const RenderControl& control = {});
  /// The same for some of the pixels, or other samples of each tile.
  RenderStatistics render_plan(const LoadedScene& scene, const WorkPlan& plan, RenderPart& part,
                               const RenderControl& control = {});
  /// Adds samples where they do most against noise, until it is small enough with kNoiseConfidence
  /// (render/film/adaptive.h), or no tile may have more, or the control ends it. The scene was loaded for that. A part
  /// that was ended early goes on as if it had not been.
  RenderStatistics render_to(const LoadedScene& scene, const NoiseRequest& request, RenderPart& part,
                             const RenderControl& control = {});

 private:
  const Log& log_;
  SessionOptions options_;
  Registry registry_;
  ThreadPool pool_;
};

}  // namespace frond
