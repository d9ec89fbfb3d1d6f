#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// Policy for features of pbrt-v4 that are not supported: errors by default; kinds that the user lists are omitted or
/// replaced, with a warning.
class Unsupported {
 public:
  Unsupported() = default;  ///< all features are errors
  /// `kinds`: "all", or names of kinds() separated by commas. Throws InputError.
  explicit Unsupported(const std::string& kinds);
  /// Returns the names of all kinds.
  static const std::vector<std::string_view>& kinds();

  /// Kinds of an export that are not in kinds() are ignored with "all" only.
  bool is_ignored(std::string_view kind) const { return passes_all_ || passing_.contains(kind); }
  /// Warns if the kind is listed; otherwise throws InputError, which names the option --ignore-unsupported. `feature`
  /// and `instead` describe the feature and its replacement: "Camera "realistic"" and "is replaced by "perspective"".
  void handle(std::string_view kind, const Location& where, std::string_view feature, std::string_view instead,
              const Log& log) const;

 private:
  std::set<std::string, std::less<>> passing_;
  bool passes_all_ = false;
};

}  // namespace frond
