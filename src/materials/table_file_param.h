#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/params.h"
#include "leaf/plates/plate_leaf.h"
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

/// R and T of a leaf material that replace all parameters of the tissue: those of a file, "string tablefile", or of a
/// leaf of PROSPECT (leaf/plates). The cuticle still shapes the surface lobe.
class TableFileParam {
 public:
  /// `also`: the material's own parameters that have no effect if R and T are given.
  TableFileParam(const Params& p, std::span<const std::string_view> also);

  /// Whether the scene gives R and T; PROSPECT's after `read`.
  bool is_given() const { return plates_ || !path_.empty(); }
  const std::filesystem::path& path() const { return path_; }
  /// Returns the file, or what else has R and T, for messages.
  std::string name() const { return plates_ ? "PROSPECT" : path_.string(); }
  /// Where the scene gives R and T.
  const Location& where() const { return where_; }
  /// Reads a leaf table or measured spectra, or computes PROSPECT's; nullptr if none is given. `surface` is the
  /// surface's share of measured light (leaf/fit/measured_table.h). Throws InputError.
  std::shared_ptr<const leaf::Table> read(const Params& p, double surface);
  /// Everything that the table read depends on, for the key of data that materials share.
  const std::string& key() const { return key_; }
  /// Warns, on the first call, of parameters that have no effect, and of values that `read` left out or changed.
  void warn(const Log& log);

 private:
  void note_unused(const Params& p, std::string_view name);

  std::filesystem::path path_;  ///< empty: no file is given
  std::optional<leaf::PlateLeaf> plates_;
  std::span<const std::string_view> also_;
  Location where_;
  std::vector<std::pair<std::string_view, Location>> unused_;  ///< parameters without effect
  std::string changes_;                                        ///< warning of `read`
  std::string key_;
};

}  // namespace frond
