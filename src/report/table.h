#pragma once

#include <string>
#include <variant>
#include <vector>

#include "instruments/errors/statistics.h"

namespace frond {

/// A column of numbers or of words. NaN and "" are missing values.
struct Column {
  std::string name;  ///< includes the unit: "wavelength_nm"; NAME_se is the standard error of NAME
  std::variant<std::vector<double>, std::vector<std::string>> values;
  std::string doc = {};      ///< one line: meaning and unit; may be empty
  bool only_data = false;    ///< omitted in text for terminals
  bool is_flag = false;      ///< numbers are 0 and 1, written as false and true
  std::string missing = {};  ///< replacement of missing numbers in files and text

  bool is_number() const { return values.index() == 0; }
  size_t size() const;
  /// Appends a CSV field (RFC 4180): 9 significant digits, 4 for a standard error, all digits of a whole number.
  void append_csv(size_t row, std::string& text) const;
};

/// A result as rows and columns. All columns have the same length. Front ends print, write and convert tables.
struct Table {
  std::string name;  ///< "measurements"; the key in JSON
  std::vector<Column> columns = {};

  size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
  /// Returns nullptr if there is no such column.
  const Column* find(const std::string& column) const;
  /// Appends a value to a column, which is created if it does not exist. A row is complete when all columns have the
  /// same length.
  void add(const std::string& column, double value);
  void add(const std::string& column, std::string value);
  /// Appends to `column` and to `column`_se.
  void add(const std::string& column, double mean, double standard_error);
  void add(const std::string& column, const MeanError& v) { add(column, v.mean, v.standard_error); }
  /// Appends true or false. This is not an overload of add, because a string literal would convert to bool.
  void add_flag(const std::string& column, bool value);
  /// Sets the documentation of an existing column.
  void document(const std::string& column, std::string doc);

 private:
  /// Returns the values of a column, which is created if it does not exist.
  template <class T>
  std::vector<T>& values(const std::string& column);
};

/// A named single value of a result.
struct Fact {
  std::string name;
  std::variant<bool, double, std::string, std::vector<double>> value;
};

/// Returns CSV: comment lines that begin with "# " (the notes, then one line for each documented column), a line of
/// column names, and one line for each row.
std::string to_csv(const Table& table, const std::vector<std::string>& notes);
/// Returns aligned columns for a terminal. A mean and its standard error share a column: "0.0412 +- 0.0003" with a
/// plus-minus sign.
std::string to_text(const Table& table);
/// Returns {"notes": [...], FACT: value, ..., TABLE: [{COLUMN: value, ...}, ...]}; a missing value is null.
std::string to_json(const std::vector<std::string>& notes, const std::vector<Fact>& facts,
                    const std::vector<Table>& tables);

}  // namespace frond
