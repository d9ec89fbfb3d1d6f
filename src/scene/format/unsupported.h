#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// Features of pbrt-v4 that are not here: errors, unless the user lets them be left out, or something else stand in for
/// them, with a warning.
class Unsupported {
 public:
  Unsupported() = default;  ///< nothing is let pass
  /// `kinds` is "all", or some of kinds() with commas between. Throws InputError.
  explicit Unsupported(const std::string& kinds);
  static const std::vector<std::string_view>& kinds();

  bool lets_pass(std::string_view kind) const { return passing_.contains(kind); }
  /// Warns where the kind is let pass; else throws InputError, with the option that would. `feature` is what is asked
  /// for, `instead` what is done for it: "Camera "realistic"" and "is replaced by "perspective"".
  void handle(std::string_view kind, const Location& where, std::string_view feature, std::string_view instead,
              const Log& log) const;

 private:
  std::set<std::string, std::less<>> passing_;
};

}  // namespace frond
