#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/text_output.h"

namespace frond {
namespace {

using Json = nlohmann::ordered_json;

bool is_error(const std::string& name) { return name.ends_with("_se"); }

const Column* error_of(const Table& table, const Column& mean) { return table.find(mean.name + "_se"); }

double number(const Column& c, size_t row) { return std::get<0>(c.values)[row]; }

bool is_whole(double v) { return v == std::floor(v) && std::abs(v) < 1e15; }

Json json_value(const Column& c, size_t row) {
  if (!c.is_number()) return std::get<1>(c.values)[row];
  const double v = number(c, row);
  if (!std::isfinite(v)) return c.missing.empty() ? Json(nullptr) : Json(c.missing);
  if (c.is_flag) return v != 0;
  if (is_whole(v)) return int64_t(v);
  return v;
}

/// Returns "mean +- error". The mean has as many decimals as two significant digits of the error.
std::string with_error(double mean, double error) {
  if (!std::isfinite(mean)) return "";
  constexpr double kNegligible = 1e-6;
  if (!std::isfinite(error) || !(error > kNegligible * std::abs(mean))) return fmt::format("{:.6g}", mean);
  const int digits = std::clamp(1 - int(std::floor(std::log10(error))), 0, 12);
  return fmt::format("{:.{}f} ± {:.{}f}", mean, digits, error, digits);
}

std::string cell(const Table& table, const Column& c, size_t row) {
  if (!c.is_number()) return std::get<1>(c.values)[row];
  const double v = number(c, row);
  if (c.is_flag) return v != 0 ? "true" : "false";
  if (const Column* error = error_of(table, c); error && !error->only_data) return with_error(v, number(*error, row));
  if (is_whole(v)) return fmt::format("{}", int64_t(v));
  return std::isfinite(v) ? fmt::format("{:.6g}", v) : c.missing;
}

/// Number of UTF-8 characters.
size_t width(const std::string& text) {
  return size_t(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

size_t Column::size() const {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

void Column::append_csv(size_t row, std::string& text) const {
  if (!is_number()) {
    text += csv_field(std::get<1>(values)[row]);
    return;
  }
  const double v = number(*this, row);
  if (!std::isfinite(v))
    text += missing;
  else if (is_flag)
    text += v != 0 ? "true" : "false";
  else if (is_whole(v))
    fmt::format_to(std::back_inserter(text), "{}", int64_t(v));
  else
    fmt::format_to(std::back_inserter(text), "{:.{}g}", v, is_error(name) ? 4 : 9);
}

template <class T>
std::vector<T>& Table::values(const std::string& column) {
  auto found = std::ranges::find(columns, column, &Column::name);
  if (found == columns.end()) found = columns.insert(columns.end(), {column, std::vector<T>()});
  return std::get<std::vector<T>>(found->values);
}

const Column* Table::find(const std::string& column) const {
  const auto found = std::ranges::find(columns, column, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

void Table::add(const std::string& column, double value) { values<double>(column).push_back(value); }

void Table::add(const std::string& column, std::string value) {
  values<std::string>(column).push_back(std::move(value));
}

void Table::add_flag(const std::string& column, bool value) {
  add(column, value ? 1.0 : 0.0);
  std::ranges::find(columns, column, &Column::name)->is_flag = true;
}

void Table::add(const std::string& column, double mean, double standard_error) {
  add(column, mean);
  add(column + "_se", standard_error);
}

void Table::document(const std::string& column, std::string doc) {
  std::ranges::find(columns, column, &Column::name)->doc = std::move(doc);
}

std::string to_csv(const Table& table, const std::vector<std::string>& notes) {
  std::string text, names;
  for (const std::string& note : notes) text += "# " + note + '\n';
  for (const Column& c : table.columns) {
    if (!c.doc.empty()) text += fmt::format("# {}: {}\n", c.name, c.doc);
    names += (names.empty() ? "" : ",") + csv_field(c.name);
  }
  text += names + '\n';
  for (size_t row = 0; row < table.rows(); ++row) {
    for (const Column& c : table.columns) {
      c.append_csv(row, text);
      text += ',';
    }
    if (!text.empty()) text.back() = '\n';
  }
  return text;
}

std::string to_text(const Table& table) {
  std::vector<std::vector<std::string>> shown;  // by column: the name, then the cells
  std::vector<size_t> widths;
  for (const Column& c : table.columns) {
    if (c.only_data || (is_error(c.name) && table.find(c.name.substr(0, c.name.size() - 3)))) continue;
    auto& cells = shown.emplace_back(1, c.name);
    for (size_t row = 0; row < table.rows(); ++row) cells.push_back(cell(table, c, row));
    widths.push_back(width(*std::ranges::max_element(cells, {}, width)));
  }
  std::string text;
  for (size_t line = 0; line <= table.rows(); ++line) {
    for (size_t i = 0; i < shown.size(); ++i)
      text += "  " + std::string(widths[i] - width(shown[i][line]), ' ') + shown[i][line];
    text += '\n';
  }
  return text;
}

std::string to_json(const std::vector<std::string>& notes, const std::vector<Fact>& facts,
                    const std::vector<Table>& tables) {
  Json json = Json::object();
  if (!notes.empty()) json["notes"] = notes;
  for (const Fact& fact : facts)
    std::visit(
        [&](const auto& value) {
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
            json[fact.name] = json_value({"", std::vector{value}}, 0);
          else
            json[fact.name] = value;
        },
        fact.value);
  for (const Table& table : tables) {
    Json& rows = json[table.name] = Json::array();
    for (size_t row = 0; row < table.rows(); ++row) {
      Json& entry = rows.emplace_back(Json::object());
      for (const Column& c : table.columns) entry[c.name] = json_value(c, row);
    }
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace frond
