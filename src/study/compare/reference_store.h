#pragma once

#include "core/log.h"
#include "study/compare/paired_render.h"

namespace frond::compare {

/// Keeps renders on disk, with all that is needed to continue them. A file that is damaged, or of something else,
/// counts as none. Files that lie unused for longest make room for new ones (system/cache_limit.h).
class ReferenceStore {
 public:
  /// `folder` empty: nothing is kept. `identity`: all that decides the pixels.
  ReferenceStore(const std::filesystem::path& folder, Identity identity, const Log& log);

  /// A file that cannot be read, or is damaged, costs a warning.
  void load(PairedRender& render) const;
  /// A folder that does not take it costs a warning.
  void save(const PairedRender& render) const;

 private:
  std::filesystem::path path_;  ///< empty: nothing is kept
  Identity identity_;
  const Log& log_;
};

}  // namespace frond::compare
