#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "system/lower_case.h"

namespace frond {

/// Field of a line of a table.
struct TableField {
  std::string_view text;  ///< without blanks and double quotes at both ends
  int column = 1;         ///< where it begins in its line, counted from 1
  bool is_quoted = false;
};

/// Where comments may begin with `#`: at the beginning of a line alone, for tables with words, or anywhere.
enum class TableComments : uint8_t { lines, anywhere };

/// Reader of tables of text, as instruments, spreadsheets, R and pandas write them, row by row.
///
/// Fields are separated by commas, semicolons, tabs or blanks, whichever the first line has; double quotes may enclose
/// them. Decimals may have a comma unless it separates fields. Lines end with LF, CRLF or CR. A byte order mark, empty
/// lines, lines of separators alone and comments are passed over. The first line names the columns unless it holds
/// numbers alone. The column of row numbers that R and pandas write, whose name is empty or missing or "Unnamed: 0",
/// has an empty name here.
class TextTable {
 public:
  /// `text` must outlive the object and its copies; `name` is the file's for messages. Throws InputError for a file
  /// that is not text, for UTF-16, and for a column other than the first that has values and no name.
  TextTable(std::string_view text, const std::string& name, TableComments comments = TableComments::lines);

  bool has_names() const { return !names_.empty(); }
  /// Names of the columns, as the file spells them; empty without a line of names.
  const std::vector<TableField>& names() const { return names_; }
  /// Number of columns: of names, or of fields of the first row; 0 for an empty file.
  size_t columns() const { return columns_; }
  /// Whether white space separates the fields.
  bool is_blank_separated() const { return separator_ == ' '; }
  /// Number of rows after the current one.
  size_t rows_left() const;

  /// Reads each row as several from now on, one for each of the `columns`: a label, the column's heading and its field.
  /// The label is that of column `label`, or else the number of the row.
  void unpivot(std::vector<size_t> columns, std::vector<std::string> headings, std::optional<size_t> label);

  /// Reads the next row. Returns false at the end.
  bool next();
  /// Fields of the row. There may be more or fewer than columns().
  const std::vector<TableField>& fields() const { return fields_; }
  /// Throws InputError unless the row has a field for each column.
  void check_fields() const;
  /// The number that a field of this table is; nullopt if it is none. It may be infinite or not a number.
  std::optional<double> number(std::string_view text) const;
  /// The number in a field of the row. Otherwise throws InputError with what the table holds, `holds`; the message does
  /// not quote the field: a scene could name any file, and its content would appear in the log.
  double number(size_t field, std::string_view holds) const;

  /// Location of the row, or of a field of it.
  Location where() const { return {file_, line_, fields_.empty() ? 1 : fields_[0].column}; }
  Location where(size_t field) const { return {file_, line_, fields_[field].column}; }
  /// Location of the line of names, or of a name; without names, of the first row.
  Location names_where() const { return {file_, first_line_, 1}; }
  Location names_where(size_t name) const { return {file_, first_line_, names_[name].column}; }

 private:
  /// State of `unpivot`.
  struct Unpivoted {
    std::vector<size_t> columns;
    std::vector<std::string> headings;
    std::optional<size_t> label;
    size_t at = 0, row = 0;  ///< next of the columns; number of the row
    std::vector<TableField> fields = {};
    std::string number = {};
  };

  bool next_row();
  bool next_line(std::string_view& line);
  void split(std::string_view line);
  void begin();
  void find_row_names();

  std::shared_ptr<const std::string> file_;
  std::string_view rest_;
  TableComments comments_;
  char line_end_ = '\n', separator_ = ' ';
  int line_ = 0, first_line_ = 1;
  size_t columns_ = 0;
  std::vector<TableField> names_, fields_;
  std::optional<Unpivoted> unpivoted_;
  std::optional<size_t> row_;  ///< number of the row, if the first column has it and the line of names does not name it
};

/// Returns the name of a column in lower case, without a unit in brackets or after a slash: "Reflectance (%)" is
/// "reflectance".
std::string name_without_unit(std::string_view name);

}  // namespace frond
