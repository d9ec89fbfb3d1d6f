#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "scene/words.h"

namespace frond {

/// The fields of a CSV file that has none in quotes; comment lines begin with #.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  const std::string& text(size_t row, const std::string& name) const {
    for (size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return rows.at(row).at(i);
    throw std::out_of_range("no column " + name);
  }
  double number(size_t row, const std::string& name) const { return std::stod(text(row, name)); }
};

inline CsvTable parse_csv(const std::string& text) {
  CsvTable table;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    const auto fields = split(line, ',');
    if (table.names.empty())
      table.names = fields;
    else
      table.rows.push_back(fields);
  }
  return table;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace frond
