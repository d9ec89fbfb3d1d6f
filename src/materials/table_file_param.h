#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/params.h"
#include "leaf/table/table.h"

namespace frond {

/// Parameters of materials that `TableFileParam::read` serves.
inline constexpr Param kTableFile{
    .name = "tablefile",
    .kind = ParamKind::string,
    .doc =
        "File with the leaf's reflectance and transmittance: a table made by frond table, or measured R and T in the "
        "format of frond fit (docs/file_formats.md); replaces all parameters of the tissue."};
inline constexpr Param kTableLeaf{.name = "tableleaf",
                                  .kind = ParamKind::string,
                                  .doc = "Name of the leaf in a tablefile with measurements of several."};

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
  /// Reads a leaf table or measured spectra; nullptr if no file is given. `surface` is the surface's share of measured
  /// light (leaf/fit/measured_table.h). Throws InputError.
  std::shared_ptr<const leaf::Table> read(const Params& p, double surface);
  /// Everything that the table read depends on, for the key of data that materials share.
  const std::string& key() const { return key_; }
  /// Warns, on the first call, of parameters that have no effect, and of values that `read` left out or changed.
  void warn(const Log& log);

 private:
  void note_unused(const Params& p, std::string_view name);

  std::filesystem::path path_;  ///< empty: no file is given
  Location where_;
  std::vector<std::pair<std::string_view, Location>> unused_;  ///< parameters without effect
  std::string changes_;                                        ///< warning of `read`
  std::string key_;
};

}  // namespace frond
