#pragma once

#include <string>
#include <variant>
#include <vector>

#include "instruments/errors/statistics.h"

namespace frond {

/// One column of a table: numbers, or words. NaN and "" stand for a value that is missing.
struct Column {
  std::string name;  ///< with its unit: "wavelength_nm"; NAME_se is the standard error of the column NAME
  std::variant<std::vector<double>, std::vector<std::string>> values;
  std::string doc = {};      ///< one line: meaning and unit; may be empty
  bool only_data = false;    ///< left out of the text for terminals
  bool is_flag = false;      ///< of numbers 0 and 1, which are written false and true
  std::string missing = {};  ///< what stands in files and text for a number that is missing

  bool is_number() const { return values.index() == 0; }
  size_t size() const;
  /// Appends a field of CSV (RFC 4180): 9 significant digits, 4 of a standard error, all of a whole number.
  void append_csv(size_t row, std::string& text) const;
};

/// A result as rows and columns. All columns have one length. This is what front ends print, write and convert.
struct Table {
  std::string name;  ///< "measurements"; the key in JSON
  std::vector<Column> columns = {};

  size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
  /// nullptr where there is none.
  const Column* find(const std::string& column) const;
  /// Appends a value to the column of that name, which becomes the last one if it is new. A row is complete when all
  /// columns have one length.
  void add(const std::string& column, double value);
  void add(const std::string& column, std::string value);
  /// `column` and `column`_se.
  void add(const std::string& column, double mean, double standard_error);
  void add(const std::string& column, const MeanError& v) { add(column, v.mean, v.standard_error); }
  /// "true" or "false". Not an overload of add: a literal would convert to bool.
  void add_flag(const std::string& column, bool value);
  /// Sets the column's documentation; the column has to exist.
  void document(const std::string& column, std::string doc);

 private:
  /// Those of the column of that name, which becomes the last one if it is new.
  template <class T>
  std::vector<T>& values(const std::string& column);
};

/// A single named value of a result.
struct Fact {
  std::string name;
  std::variant<bool, double, std::string, std::vector<double>> value;
};

/// CSV: comment lines that begin with "# " (the notes, then a line for each documented column), a line of column names,
/// a line for each row.
std::string to_csv(const Table& table, const std::vector<std::string>& notes);
/// Aligned columns for a terminal; a mean and its standard error are one column, "0.0412 ± 0.0003".
std::string to_text(const Table& table);
/// {"notes": [...], FACT: value, ..., TABLE: [{COLUMN: value, ...}, ...]}; a missing value is null.
std::string to_json(const std::vector<std::string>& notes, const std::vector<Fact>& facts,
                    const std::vector<Table>& tables);

}  // namespace frond
