#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "system/lower_case.h"

namespace frond {

/// A statement of an OBJ or MTL file.
struct ObjStatement {
  size_t line = 0;           ///< from 1
  std::string_view keyword;  ///< as it is written
  std::string_view rest;     ///< without blanks at its ends
};

/// Reads the statements of an OBJ or MTL file one after the other. Lines may end with a carriage return, a line feed or
/// both. Comments and empty lines are left out.
class ObjLines {
 public:
  /// A backslash at the end continues a line on the next one if `is_continued`: not in MTL files, whose paths may end
  /// with one. Throws std::runtime_error for UTF-16.
  ObjLines(std::string_view text, bool is_continued);
  /// Returns the next statement, whose text is valid until the next call; nothing at the end.
  std::optional<ObjStatement> next();

 private:
  /// Takes a line from the rest of the text.
  std::string_view take_line();

  std::string_view rest_;
  bool is_continued_;
  size_t line_ = 0;
  std::string joined_;  ///< of continued lines
};

/// Returns a statement's words, up to a comment.
void split_words(std::string_view text, std::vector<std::string_view>& words);
/// Parses a number, which takes the whole word; its decimal point may be a comma.
std::optional<double> number_of(std::string_view word);

}  // namespace frond
