#include "tests/stability/page.h"

#include <fmt/format.h>

#include <iterator>

namespace frond::stability {
namespace {

constexpr std::string_view kHowToRead = R"(# Limits of the methods

For readers who need to know what frond's leaf methods, its sky and its media do at the ends of their parameter ranges, at grazing
angles and with wrong input.

```sh
measurements/run stability
```

The command runs every case and writes this page. `frond_stability`, one of the tests, runs the same cases and fails
if a result is not the expected one. No result on this page is unexpected: no method returns NaN, a negative value or
infinity, and none clamps a value silently.

Rows are cases with their expected result; columns are methods. A cell is the result of one method:

| result | meaning |
|---|---|
| exact, se 2e-3 | agrees with the true value within 5 standard errors; the largest standard error |
| exact | agrees with the true value to rounding in double precision |
| error 5e-5 | a method without noise: its largest error, which is within the expected bound |
| error below 1e-6 | an error whose digits depend on the compiler more than on the method |
| holds | every expected property was checked and holds |
| refused: ... | refused, with this message |
| - | the method does not apply |

Numbers are rounded up to 1, 2 or 5 times a power of ten. The true value is a closed form if there is one, otherwise a
result of the solver with twice its default nodes. A correct method differs by more than 5 standard errors with
probability 6e-7; the bound for rare outcomes includes a further 10 rays. Seeds are fixed, so the page is the same
each time.

)";

constexpr std::array<MethodName, kMethods> kNames{{
    {"walk", "`leaf::walk`, one ray at a time, analog absorption"},
    {"weighted walk", "`leaf::walk`, weighted absorption"},
    {"batched walk", "`leaf::walk_batch`, single precision, analog and weighted"},
    {"spectral walk", "`leaf::walk` for four wavelengths at once"},
    {"spectral f", "`leaf::estimate_subsurface_f` for four wavelengths at once, integrated over all directions"},
    {"solver", "`leaf::solve`"},
    {"abm", "material `abm`: `sample`, `f` and `pdf`"},
    {"simplified", "material `leaf_simplified` with a solved table"},
    {"simplified, walked", "material `leaf_simplified` with a table of 1000 walks for each degree"},
    {"table file", "material `leaf_simplified` with `tablefile`"},
    {"solved leaf",
     "material `leaf_solved`, f integrated over all directions: R and T within its tolerance, 5e-4 "
     "([leaf models](../leaf_models.md))"},
    {"solved f",
     "material `leaf_solved`, pi f by direction, against a mode table of twice the nodes solved at these angles"},
    {"lambert", "material `leaf_lambert`, R and T with `incidence` set to each angle of the case up to 89 degrees"},
    {"spectrophotometer", "`measure_shares` of `abm`, as `frond spectrophotometer` calls it"},
    {"goniophotometer", "`measure_f` and its sphere of detectors, as `frond goniophotometer` calls them"},
    {"path, abm", "the path integrator, rendering a scene with `abm`"},
    {"path, weighted abm", "the same with `abm` in its weighted mode"},
    {"path, simplified", "the same with `leaf_simplified`"},
    {"path, solved leaf", "the same with `leaf_solved`"},
    {"path, lambert", "the same with `leaf_lambert`, whose R and T are those of 8 degrees"},
    {"sky", "light `sky`: radiance and densities over all directions, and 20,000 samples"},
    {"path, sky", "the path integrator, rendering a white plane that faces up, under the light `sky`"},
    {"homogeneous", "the volpath integrator, rendering a ball of the medium `homogeneous`"},
    {"uniformgrid", "the same with `uniformgrid`"},
    {"rgbgrid", "the same with `rgbgrid`"},
    {"cloud", "the same with `cloud`"},
    {"nanovdb", "the same with `nanovdb`, of a fog volume of a torus"},
    {"measured", "material `measured`: f integrated over all directions, and `sample`"},
    {"hair", "material `hair`: `sample`, `f` and `pdf`"},
    {"path, subsurface", "the path integrator, rendering a plane of `subsurface`"},
    {"volpath, subsurface", "the same with the volpath integrator"},
}};

/// Escapes the characters that Markdown interprets.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_' || c == '~') result += '\\';
    result += c;
  }
  return result;
}

std::string markdown_row(const std::vector<std::string>& fields) {
  std::string line = "|";
  for (const std::string& field : fields) line += fmt::format(" {} |", escaped(field));
  return line + "\n";
}

std::string cell_text(const Row& row, Method method) {
  const auto cell = row.cells.find(method);
  if (cell == row.cells.end()) return "-";
  return (cell->second.is_surprise ? "UNEXPECTED: " : "") + cell->second.text;
}

std::string to_markdown(const Theme& theme) {
  std::vector<std::string> heads{"case", "expected"};
  for (const Method m : theme.methods()) heads.emplace_back(describe(m).name);
  std::string text = fmt::format("## {}\n\n{}\n\n{}", theme.title, theme.text, markdown_row(heads));
  text += markdown_row(std::vector<std::string>(heads.size(), "---"));
  for (const Row& row : theme.rows) {
    std::vector<std::string> fields{row.name, row.expected};
    for (const Method m : theme.methods()) fields.push_back(cell_text(row, m));
    text += markdown_row(fields);
  }
  return text;
}

/// Calls act(theme, row, method, cell).
template <class Act>
void for_each_cell(const std::vector<Theme>& themes, const Act& act) {
  for (const Theme& theme : themes)
    for (const Row& row : theme.rows)
      for (const auto& [method, cell] : row.cells) act(theme, row, method, cell);
}

}  // namespace

const MethodName& describe(Method method) { return kNames[static_cast<size_t>(method)]; }

std::vector<Method> Theme::methods() const {
  std::map<Method, bool> met;
  for (const Row& row : rows)
    for (const auto& [method, cell] : row.cells) met[method] = true;
  std::vector<Method> result;
  for (const auto& [method, is_met] : met) result.push_back(method);
  return result;
}

std::vector<std::string> surprises(const std::vector<Theme>& themes) {
  std::vector<std::string> lines;
  for_each_cell(themes, [&](const Theme& theme, const Row& row, Method method, const Cell& cell) {
    if (cell.is_surprise)
      lines.push_back(fmt::format("{}: {}: {}: expected \"{}\", found \"{}\"", theme.title, row.name,
                                  describe(method).name, row.expected, cell.text));
  });
  return lines;
}

std::string to_text(const std::vector<Theme>& themes) {
  std::string text;
  for_each_cell(themes, [&](const Theme& theme, const Row& row, Method method, const Cell&) {
    fmt::format_to(std::back_inserter(text), "{}: {}: {}: {}\n", theme.title, row.name, describe(method).name,
                   cell_text(row, method));
  });
  return text;
}

std::string to_markdown(const std::vector<Theme>& themes) {
  std::string text = std::string(kHowToRead) + "| column | method |\n|---|---|\n";
  for (const auto& [name, doc] : kNames) text += fmt::format("| {} | {} |\n", name, doc);
  for (const Theme& theme : themes) text += "\n" + to_markdown(theme);
  return text;
}

}  // namespace frond::stability
