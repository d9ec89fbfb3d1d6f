#pragma once

#include "core/log.h"
#include "study/compare/paired_render.h"

namespace frond::compare {

/// Stores renders on disk with the state needed to continue them. A damaged file, or a file of another render, is
/// ignored. Files that have been unused for longest are deleted for new ones (system/cache_limit.h).
class ReferenceStore {
 public:
  /// `folder` empty: nothing is stored. `identity`: everything that decides the pixels.
  ReferenceStore(const std::filesystem::path& folder, Identity identity, const Log& log);

  /// Loads a stored render, if any. Warns about a file that is unreadable or damaged.
  void load(PairedRender& render) const;
  /// Stores the render. Warns if the folder is not writable.
  void save(const PairedRender& render) const;

 private:
  std::filesystem::path path_;  ///< empty: nothing is stored
  Identity identity_;
  const Log& log_;
};

}  // namespace frond::compare
