#pragma once

#include <set>

#include "core/log.h"
#include "core/parallel.h"
#include "exports/mitsuba/folder.h"
#include "exports/mitsuba/spectra.h"
#include "scene/resolver.h"

namespace frond::mitsuba {

/// What the writers of an export's parts share. All throw InputError, at the scene file's position, for what Mitsuba
/// has no equivalent of.
struct Context {
  const SceneDescription& description;
  const Registry& registry;
  SceneResolver& resolver;
  const Spectra& spectra;
  Folder& folder;
  ThreadPool& pool;
  const Log& log;
  const std::filesystem::path& cache;
  /// Mitsuba's units per unit of frond's scene. Mitsuba offsets ray origins by about 1e-4 (1 + the largest coordinate):
  /// with large units this is 1e-4 of the coordinates.
  double units = 1;
  double exposure = 1;  ///< of the film, by which all emission is multiplied, because Mitsuba's film has none
  std::set<std::string> said = {};

  /// Warns of a difference between both programs, once for each place.
  void warn(const Location& where, const std::string& message) {
    if (said.insert(where.text() + message).second) log.warn(where, message);
  }
};

}  // namespace frond::mitsuba
