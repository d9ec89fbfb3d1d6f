#pragma once

#include <set>

#include "core/log.h"
#include "core/messages/problems.h"
#include "core/parallel.h"
#include "exports/mitsuba/folder.h"
#include "exports/mitsuba/spectra.h"
#include "scene/format/unsupported.h"
#include "scene/resolver.h"

namespace frond::mitsuba {

/// State that the writers of an export's parts share. They report features without an equivalent in Mitsuba by
/// `report_unsupported`, and continue with a substitute, so that one run finds all of them; InputErrors of single
/// materials, shapes and lights are collected in `problems`.
struct Context {
  const SceneDescription& description;
  const Registry& registry;
  SceneResolver& resolver;
  const Spectra& spectra;
  Folder& folder;
  ThreadPool& pool;
  const Log& log;
  const std::filesystem::path& cache;
  const Unsupported& unsupported;
  Problems& problems;
  /// Mitsuba's units per unit of frond's scene. Mitsuba offsets ray origins by about 1e-4 (1 + the largest coordinate):
  /// with large units this is 1e-4 of the coordinates.
  double units = 1;
  double exposure = 1;  ///< of the film, by which all emission is multiplied, because Mitsuba's film has none
  std::set<std::string> said = {};

  /// Warns of a difference between both programs, once for each place.
  void warn(const Location& where, const std::string& message) {
    if (said.insert(where.text() + message).second) log.warn(where, message);
  }
  /// Reports a feature without an equivalent in Mitsuba: a warning if --ignore-unsupported lists its kind, otherwise an
  /// error. `instead` states what is exported in its place, and what is lost. Returns whether it is a warning.
  bool report_unsupported(std::string_view kind, const Location& where, const std::string& what,
                          std::string_view instead) {
    const bool passes = unsupported.is_ignored(kind);
    if (passes)
      warn(where, fmt::format("{}: {}", what, instead));
    else
      problems.add(InputError(where, fmt::format("{}; with --ignore-unsupported {}", what, instead)));
    return passes;
  }
};

}  // namespace frond::mitsuba
