#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frond {

inline constexpr std::string_view kSimplified = "leaf_simplified", kSolved = "leaf_solved";

/// What `frond table` is told: [MATERIAL] name=value ...
struct TableWords {
  std::string_view material = kSimplified;  ///< whose table it is
  std::vector<std::string> leaf;            ///< name=value: what makes the leaf
};

/// With `specimen`, unless it is empty, as one more parameter. Throws InputError for a material that looks up no table,
/// for parameters given twice, and for those of a material for which the command has options.
TableWords parse_table_words(std::vector<std::string> words, const std::string& specimen);

}  // namespace frond
