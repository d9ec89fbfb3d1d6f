#pragma once

#include <memory>

#include "render/session.h"
#include "scene/format/unsupported.h"
#include "study/compare/candidate.h"

namespace frond::compare {

/// What decides the images beside the candidates.
struct StudyOptions {
  std::string scene = {}, wavelengths = {};  ///< wavelengths: a PluginText; empty: the scene's
  std::vector<std::string> leaves = {};      ///< names of the materials that candidates replace; empty: every leaf
  Unsupported unsupported = {};
  std::optional<uint64_t> seed = {};  ///< 0 by default
  int size = 256;                     ///< pixels of the image's longer side
};

/// One scene, in which one leaf model stands for another.
class Study {
 public:
  /// The session must outlive it. Throws InputError.
  Study(Session& session, const StudyOptions& options);

  /// With the candidate in place of the leaves; all of them have one geometry. Throws InputError.
  std::shared_ptr<const Scene> scene(const Candidate& candidate) const;
  /// One of those that have been made; nullptr where none has.
  const std::shared_ptr<const Scene>& any_scene() const { return first_; }
  /// The scene's sampler, with a seed of its own.
  std::unique_ptr<Sampler> sampler(const Scene& scene, uint64_t seed) const;
  /// The scene's integrator with these over it.
  std::unique_ptr<Integrator> integrator(const Scene& scene, const PluginText& over) const;

  /// From which those of all renders are made.
  uint64_t seed() const { return description_.seed.value_or(0); }
  const FilmSettings& film() const { return film_; }
  const SceneSettings& description() const { return description_; }
  /// Which put a material in the leaves' place.
  std::vector<MaterialSwap> swaps_to(const PluginText& material) const;
  /// Names of the materials that candidates replace.
  const std::vector<std::string>& leaves() const { return leaves_; }
  /// The scene's integrator, by name.
  const std::string& integrator_name() const { return description_.integrator.name; }
  Session& session() const { return session_; }
  const Registry& registry() const { return session_.registry(); }
  /// All that decides the pixels of a candidate's renders, but the seeds that each of them has of its own.
  Identity identity(const Candidate& candidate) const;

 private:
  SceneDescription described(const Candidate& candidate, const Log& log) const;

  Session& session_;
  SceneDescription description_;
  FilmSettings film_;
  std::vector<std::string> leaves_;
  std::vector<MaterialSwap> swaps_;             ///< without what they put in
  mutable std::shared_ptr<const Scene> first_;  ///< that was asked for: the others share what stands in it
};

}  // namespace frond::compare
