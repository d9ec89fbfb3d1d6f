#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace frond::stability {

/// Whatever computes something of a leaf. The columns of the page.
enum class Method : uint8_t {
  walk_analog,
  walk_weighted,
  batch,
  spectral_walk,
  spectral_f,
  solver,
  abm,
  simplified,
  simplified_walked,
  table_file,
  solved_leaf,
  solved_f,
  lambert,
  spectrophotometer,
  goniophotometer,
  path_abm,
  path_weighted,
  path_simplified,
  path_solved,
  path_lambert,
};
struct MethodName {
  std::string_view name, doc;
};
const MethodName& describe(Method method);
inline constexpr size_t kMethods = 20;

/// What one method did in one case.
struct Cell {
  std::string text;
  bool is_surprise = false;
};

/// One case: what it is, what is expected, and what each method that it concerns made of it.
struct Row {
  std::string name, expected;
  std::map<Method, Cell> cells = {};

  Row& add(Method method, Cell cell) {
    cells[method] = std::move(cell);
    return *this;
  }
};

/// Cases that are read together.
struct Theme {
  std::string title, text;
  std::vector<Row> rows = {};

  Row& add(std::string name, std::string expected) {
    return rows.emplace_back(Row{std::move(name), std::move(expected)});
  }
  /// Those that any of its rows concerns, in their order.
  std::vector<Method> methods() const;
};

/// One line for each cell that is not as expected.
std::vector<std::string> surprises(const std::vector<Theme>& themes);

/// For people at a terminal: a line for each cell.
std::string to_text(const std::vector<Theme>& themes);

/// docs/stability.md: how to read it, and a table for each theme.
std::string to_markdown(const std::vector<Theme>& themes);

}  // namespace frond::stability
