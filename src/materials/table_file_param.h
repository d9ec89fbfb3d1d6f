#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/log.h"
#include "core/params.h"

namespace frond {

/// "string tablefile" of a leaf material: a file that stands in place of all that the scene says of the tissue. The
/// cuticle still shapes the surface lobe.
class TableFileParam {
 public:
  /// `also`: the material's own parameters that have no effect beside it.
  TableFileParam(const Params& p, std::span<const std::string_view> also);

  bool is_given() const { return !path_.empty(); }
  const std::filesystem::path& path() const { return path_; }
  const Location& where() const { return where_; }
  /// Of parameters that are given in vain: once.
  void warn(const Log& log);

 private:
  struct Unused {
    std::string_view name;
    Location where;
  };
  void look_for(const Params& p, std::span<const std::string_view> names);

  std::filesystem::path path_;  ///< empty: there is none
  Location where_;
  std::vector<Unused> unused_;
};

}  // namespace frond
