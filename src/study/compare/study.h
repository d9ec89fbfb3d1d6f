#pragma once

#include <memory>

#include "render/session.h"
#include "scene/format/unsupported.h"
#include "study/compare/candidate.h"

namespace frond::compare {

/// Settings that decide the images, apart from the candidates.
struct StudyOptions {
  std::string scene = {}, wavelengths = {};  ///< wavelengths: a PluginText; empty: the scene's
  std::vector<std::string> leaves = {};      ///< names of the materials to replace; empty: every leaf
  Unsupported unsupported = {};
  std::optional<uint64_t> seed = {};  ///< 0 by default
  int size = 256;                     ///< pixels of the image's longer side
};

/// A scene in which candidates replace the leaf materials.
class Study {
 public:
  /// `session` must outlive this object. Throws InputError.
  Study(Session& session, const StudyOptions& options);
  /// Same, for a scene that has been read; options.scene is then its name.
  Study(Session& session, SceneDescription description, const StudyOptions& options);

  /// Returns the scene with the candidate's material. All scenes share one geometry. Throws InputError.
  std::shared_ptr<const Scene> scene(const Candidate& candidate) const;
  /// Returns a scene that has been built; nullptr if there is none.
  const std::shared_ptr<const Scene>& any_scene() const { return first_; }
  /// Returns the scene's sampler with another seed.
  std::unique_ptr<Sampler> sampler(const Scene& scene, uint64_t seed) const;
  /// Returns the scene's integrator with overridden parameters.
  std::unique_ptr<Integrator> integrator(const Scene& scene, const PluginText& over) const;

  /// Seed from which the seeds of all renders are derived.
  uint64_t seed() const { return description_.seed.value_or(0); }
  const FilmSettings& film() const { return film_; }
  const SceneSettings& description() const { return description_; }
  /// Returns swaps that replace the leaves by a material.
  std::vector<MaterialSwap> swaps_to(const PluginText& material) const;
  /// Names of the materials that candidates replace.
  const std::vector<std::string>& leaves() const { return leaves_; }
  /// Name of the scene's integrator.
  const std::string& integrator_name() const { return description_.integrator.name; }
  Session& session() const { return session_; }
  const Registry& registry() const { return session_.registry(); }
  /// Returns everything that decides the pixels of a candidate's renders, except their own seeds.
  Identity identity(const Candidate& candidate) const;

 private:
  SceneDescription described(const Candidate& candidate, const Log& log) const;

  Session& session_;
  SceneDescription description_;
  FilmSettings film_;
  std::vector<std::string> leaves_;
  std::vector<MaterialSwap> swaps_;             ///< without the materials to insert
  mutable std::shared_ptr<const Scene> first_;  ///< the first scene built; others share its geometry
};

}  // namespace frond::compare
