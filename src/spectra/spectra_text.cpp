#include "spectra/spectra_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "spectra/envi_library.h"
#include "system/lower_case.h"
#include "system/trimmed.h"

namespace frond {
namespace {

/// Lines without their ends.
std::vector<std::string_view> lines_of(std::string_view text) {
  const char end = text.find('\n') == text.npos ? '\r' : '\n';
  std::vector<std::string_view> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t at = std::min(text.find(end, begin), text.size());
    lines.push_back(trimmed(text.substr(begin, at - begin)));
    begin = at + 1;
  }
  return lines;
}

bool begins_with_a_number(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of("+-."), line.size()));
  return !line.empty() && line[0] >= '0' && line[0] <= '9';
}

/// What follows "KEY:" in one of the lines, in lower case.
std::optional<std::string> value_of(std::span<const std::string_view> lines, std::string_view key) {
  for (const std::string_view line : lines)
    if (line.size() > key.size() && lower_case(line.substr(0, key.size())) == key && line[key.size()] == ':')
      return lower_case(trimmed(line.substr(key.size() + 1)));
  return {};
}

/// The lines from `first` on, after one that names the columns, at the numbers that they have.
std::string table_from(const std::vector<std::string_view>& lines, size_t first, const std::string& names) {
  std::string text(std::max<size_t>(first, 1) - 1, '\n');
  text += names + '\n';
  for (size_t i = first; i < lines.size(); ++i) text.append(lines[i]) += '\n';
  return text;
}

size_t first_numbers(const std::vector<std::string_view>& lines) {
  return size_t(std::ranges::find_if(lines, begins_with_a_number) - lines.begin());
}

std::optional<SpectraText> spectra_vista(const std::vector<std::string_view>& lines) {
  if (!lines[0].starts_with("/*** Spectra Vista")) return {};
  const auto data = std::ranges::find_if(lines, [](std::string_view line) { return line.starts_with("data="); });
  if (data == lines.end()) return {};
  return SpectraText{table_from(lines, size_t(data - lines.begin()) + 1, "wavelength reference target R(%)"),
                     "Spectra Vista (.sig)"};
}

std::optional<SpectraText> library(const std::vector<std::string_view>& lines) {
  const size_t first = first_numbers(lines);
  const auto head = std::span(lines).first(first);
  const auto x = value_of(head, "x units"), y = value_of(head, "y units");
  if (!x || !y || first == lines.size() || first == 0) return {};
  const std::string unit = x->find("micro") != x->npos || x->find("um") != x->npos ? "um" : "nm";
  // Emissivity and others keep their names, and are refused by name.
  std::string share = y->find("reflectance") != y->npos ? "R" : y->find("transmittance") != y->npos ? "T" : *y;
  if (share.size() == 1 && y->find("percent") != y->npos) share += "(%)";
  const bool has_tabs = lines[first].find('\t') != std::string_view::npos;
  return SpectraText{
      table_from(lines, first, fmt::format("wavelength({}){}\"{}\"", unit, has_tabs ? '\t' : ' ', share)),
      "ECOSTRESS or ASTER library"};
}

std::optional<SpectraText> envi_plot(const std::vector<std::string_view>& lines) {
  if (!lines[0].starts_with("ENVI ASCII Plot")) return {};
  const size_t first = first_numbers(lines);
  if (first == lines.size()) return {};
  std::string names;
  for (const std::string_view line : std::span(lines).first(first)) {
    const size_t colon = line.find(':');
    if (!line.starts_with("Column ") || colon == line.npos) continue;
    std::string name(trimmed(line.substr(colon + 1, line.find("~~") - colon - 1)));
    std::erase(name, '"');
    names += fmt::format("{}\"{}\"", names.empty() ? "" : " ", name);
  }
  if (names.empty()) return {};
  return SpectraText{table_from(lines, first, names), "ENVI ASCII plot"};
}

/// NASA's SeaBASS, the layout of OceanColor's response functions: lines "/KEY=VALUE" up to "/end_header".
std::optional<SpectraText> seabass(const std::vector<std::string_view>& lines) {
  const auto end = std::ranges::find_if(lines, [](std::string_view line) { return line.starts_with("/end_header"); });
  if (end == lines.end() || std::find(lines.begin(), end, "/begin_header") == end) return {};
  const auto value = [&](std::string_view key) {
    const auto line = std::find_if(lines.begin(), end, [&](std::string_view l) { return l.starts_with(key); });
    return line == end ? std::string_view() : line->substr(key.size());
  };
  std::string names(value("/fields="));
  if (names.empty()) return {};
  if (names_wavelengths(names.substr(0, names.find(','))) && value("/units=").starts_with("um"))
    names.insert(names.find(','), "(um)");
  const std::string_view delimiter = value("/delimiter=");
  if (delimiter != "comma") std::ranges::replace(names, ',', delimiter == "tab" ? '\t' : ' ');
  return SpectraText{table_from(lines, size_t(end - lines.begin()) + 1, names), "SeaBASS"};
}

/// A table whose line of names follows lines that are no comments.
std::optional<SpectraText> after_a_head(const std::vector<std::string_view>& lines) {
  constexpr size_t kLongestHead = 500;
  bool has_head = false;
  for (size_t i = 0; i + 1 < std::min(lines.size(), kLongestHead); ++i) {
    std::string_view name = lines[i].substr(0, lines[i].find_first_of(",;\t "));
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (names_wavelengths(name) && name.size() < lines[i].size() && begins_with_a_number(lines[i + 1])) {
      if (!has_head) return {};
      const bool is_sed = value_of(std::span(lines).first(i), "data").has_value() || lines[i - 1] == "Data:";
      return SpectraText{table_from(lines, i + 1, std::string(lines[i])), is_sed ? "Spectral Evolution (.sed)"
                                                                          : lines[0] == kEnviLibrary
                                                                              ? "spectral library of ENVI"
                                                                              : "a table after other lines"};
    }
    has_head = has_head || (!lines[i].empty() && lines[i][0] != '#');
  }
  return {};
}

}  // namespace

bool names_wavelengths(std::string_view name) {
  constexpr std::array<std::string_view, 12> kNames{"wavelength", "wavelength_nm", "wavelengths", "nm",
                                                    "lambda",     "lambda_nm",     "wvl",         "wl",
                                                    "wave",       "waves",         "wavelen",     "sr_wl"};
  return std::ranges::find(kNames, name_without_unit(name)) != kNames.end();
}

bool is_in_micrometres(std::string_view name) {
  const std::string unit = lower_case(name.substr(std::min(name.find_first_of("([/"), name.size())));
  return unit.find("um") != unit.npos || unit.find("\u00b5m") != unit.npos || unit.find("\u03bcm") != unit.npos ||
         unit.find("micro") != unit.npos;
}

std::optional<size_t> wavelength_column(const std::vector<TableField>& names) {
  const auto found = std::ranges::find_if(names, [](const TableField& f) { return names_wavelengths(f.text); });
  return found == names.end() ? std::nullopt : std::optional(size_t(found - names.begin()));
}

WavelengthNames wavelength_names(const std::vector<TableField>& names) {
  std::map<std::string, WavelengthNames> by_prefix;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(names[i].text);
    const size_t begin = std::min(name.find_first_of("0123456789"), name.size());
    const size_t end = std::min(name.find_first_not_of("0123456789.", begin), name.size());
    const std::string nm = name.substr(begin, end - begin), after = name.substr(end);
    if (nm.empty() || (!after.empty() && after != "nm" && after != "_nm" && after != " nm")) continue;
    WavelengthNames& found = by_prefix[name.substr(0, begin)];
    found.columns.push_back(i), found.nm.push_back(nm);
  }
  constexpr size_t kLeast = 5;
  WavelengthNames most;
  for (auto& [prefix, found] : by_prefix)
    if (found.columns.size() >= kLeast && found.columns.size() > most.columns.size()) most = std::move(found);
  return most;
}

SpectraText spectra_text(std::string_view text) {
  const std::vector<std::string_view> lines = lines_of(text);
  if (!lines.empty())
    for (auto* const layout : {&spectra_vista, &envi_plot, &library, &seabass, &after_a_head})
      if (auto found = layout(lines)) return std::move(*found);
  return {std::string(text), {}};
}

}  // namespace frond
