#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace frond::stability {

/// Methods that compute a leaf's optics, the sky light, and media: the columns of the page.
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
  sky_light,
  path_sky,
  homogeneous,
  uniform_grid,
  rgb_grid,
  cloud,
  nanovdb,
  measured,
  hair,
  path_subsurface,
  volpath_subsurface,
};
struct MethodName {
  std::string_view name, doc;
};
const MethodName& describe(Method method);
inline constexpr size_t kMethods = 31;

/// Result of one method in one case.
struct Cell {
  std::string text;
  bool is_surprise = false;
};

/// One case: its name, the expected result, and the result of each method that it applies to.
struct Row {
  std::string name, expected;
  std::map<Method, Cell> cells = {};

  Row& add(Method method, Cell cell) {
    cells[method] = std::move(cell);
    return *this;
  }
};

/// A table of related cases.
struct Theme {
  std::string title, text;
  std::vector<Row> rows = {};

  Row& add(std::string name, std::string expected) {
    return rows.emplace_back(Row{std::move(name), std::move(expected)});
  }
  /// The methods with a cell in any row, in order.
  std::vector<Method> methods() const;
};

/// One line for each unexpected cell.
std::vector<std::string> surprises(const std::vector<Theme>& themes);

/// One line for each cell, for a terminal.
std::string to_text(const std::vector<Theme>& themes);

/// docs/results/stability.md: its introduction, and a table for each theme.
std::string to_markdown(const std::vector<Theme>& themes);

}  // namespace frond::stability
