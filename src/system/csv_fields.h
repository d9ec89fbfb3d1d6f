#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

/// A field of a line, with its position.
struct CsvField {
  std::string_view text;
  Location where;
};

/// Returns the text without blanks and double quotes at both ends.
std::string_view trimmed(std::string_view text);

/// Splits a line at a separator; a field in double quotes can contain it. With a blank as the separator, fields are
/// separated by one or more. `where`: of the line. Fields are trimmed.
std::vector<CsvField> split_fields(std::string_view line, char separator, Location where);

/// Returns the number that the whole text is; decimals may have a comma unless it separates fields.
std::optional<double> field_number(std::string_view text, char separator);

}  // namespace frond
