#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/log.h"
#include "core/params.h"

namespace frond {

/// Parameter "string tablefile" of a leaf material: a file that replaces all parameters of the tissue. The cuticle
/// still shapes the surface lobe.
class TableFileParam {
 public:
  /// `also`: the material's own parameters that have no effect if a file is given.
  TableFileParam(const Params& p, std::span<const std::string_view> also);

  /// Whether the scene gives a file.
  bool is_given() const { return !path_.empty(); }
  const std::filesystem::path& path() const { return path_; }
  /// Where the scene names the file.
  const Location& where() const { return where_; }
  /// Warns, on the first call, of parameters that have no effect.
  void warn(const Log& log);

 private:
  struct Unused {
    std::string_view name;
    Location where;
  };
  void look_for(const Params& p, std::span<const std::string_view> names);

  std::filesystem::path path_;  ///< empty: no file is given
  Location where_;
  std::vector<Unused> unused_;
};

}  // namespace frond
