#include "system/text_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "system/trimmed.h"

namespace frond {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// Returns the index after the quoted text that begins at `begin`, in which "" stands for a quote; `begin` if there is
/// none or it is not closed.
size_t end_of_quotes(std::string_view line, size_t begin) {
  if (begin >= line.size() || line[begin] != '"') return begin;
  for (size_t quote = begin; (quote = line.find('"', quote + 1)) != line.npos; ++quote)
    if (quote + 1 >= line.size() || line[quote + 1] != '"') return quote + 1;
  return begin;
}

/// Returns the index of the first wanted character outside quotes, at `begin` or after it; the line's end if there is
/// none.
template <class Test>
size_t find_outside_quotes(std::string_view line, size_t begin, const Test& is_wanted) {
  for (size_t i = begin; i < line.size(); ++i) {
    if (line[i] == '"') {
      const size_t end = end_of_quotes(line, i);
      if (end > i) i = end;
      if (i >= line.size()) break;
    }
    if (is_wanted(line[i])) return i;
  }
  return line.size();
}

std::optional<double> parsed(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<double> parsed_with_comma(std::string_view text) {
  std::string plain(text);
  std::ranges::replace(plain, ',', '.');
  return parsed(plain);
}

/// Whether white space separates numbers, some of which have decimal commas: "0,05 0,2 1".
bool has_decimal_commas(std::string_view line) {
  size_t count = 0;
  for (size_t begin = 0; begin < line.size(); ++count) {
    const size_t end = size_t(std::find_if(line.begin() + ptrdiff_t(begin), line.end(), is_blank) - line.begin());
    const std::string_view word = line.substr(begin, end - begin);
    if (word.starts_with(',') || word.ends_with(',') || !parsed_with_comma(word)) return false;
    for (begin = end; begin < line.size() && is_blank(line[begin]);) ++begin;
  }
  return count > 1;
}

char separator_of(std::string_view line) {
  for (const char c : {';', '\t', ','}) {
    if (find_outside_quotes(line, 0, [c](char other) { return other == c; }) == line.size()) continue;
    return c == ',' && has_decimal_commas(line) ? ' ' : c;
  }
  return ' ';
}

TableField field_of(std::string_view line, size_t begin, size_t end) {
  TableField field{line.substr(begin, end - begin), static_cast<int>(begin) + 1};
  while (!field.text.empty() && is_blank(field.text.front())) field.text.remove_prefix(1), ++field.column;
  field.text = trimmed(field.text);
  if (field.text.empty()) field.column = static_cast<int>(begin) + 1;
  if (field.text.size() > 1 && field.text.front() == '"' && field.text.back() == '"') {
    field.is_quoted = true;
    field.text = trimmed(field.text.substr(1, field.text.size() - 2));
  }
  return field;
}

/// Throws InputError for bytes that are not UTF-8 or another extension of ASCII.
void check_text(std::string_view text, const Location& where) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    fail(where, "the file is UTF-16 text: save it as UTF-8 (in a spreadsheet: \"CSV UTF-8\")");
  if (text.starts_with("PK\x03\x04") || text.starts_with("\xd0\xcf\x11\xe0"))
    fail(where,
         "the file is a workbook (.xlsx, .xls): save its sheet as CSV, in a spreadsheet or by "
         "pandas.read_excel(FILE, sheet_name=...).to_csv(...)");
  const bool is_binary = text.find('\0') != text.npos;
  if (is_binary && (text.starts_with("ASD") || (text.starts_with("as") && text[2] >= '2' && text[2] <= '8')))
    fail(where, "the file is a binary spectrum of ASD: export it as text, by ViewSpec or by the package pyASDReader");
  if (is_binary) fail(where, "not a text file: a table of text, such as CSV, is expected");
}

}  // namespace

std::string name_without_unit(std::string_view name) {
  return lower_case(trimmed(name.substr(0, std::min(name.find_first_of("([/%"), name.size()))));
}

TextTable::TextTable(std::string_view text, const std::string& name, TableComments comments)
    : file_(std::make_shared<const std::string>(name)), rest_(text), comments_(comments) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  check_text(rest_, {file_, 1, 1});
  if (rest_.find('\n') == rest_.npos) line_end_ = '\r';
  begin();
}

/// Finds the separator and the names of columns.
void TextTable::begin() {
  const std::string_view start = rest_;
  std::string_view line;
  if (!next_line(line)) {
    first_line_ = std::max(line_, 1);
    return;
  }
  first_line_ = line_;
  separator_ = separator_of(trimmed(line));
  split(line);
  columns_ = fields_.size();
  const auto is_number = [this](const TableField& f) { return f.text.empty() || number(f.text); };
  // A Series of pandas has the names "" and "0".
  if (!fields_[0].text.empty() && std::ranges::all_of(fields_, is_number)) {
    rest_ = start, line_ = 0;
    fields_.clear();
    return;
  }
  names_ = fields_;
  find_row_names();
  fields_.clear();
}

/// Gives row numbers, which R writes without a name, an empty one; refuses other columns without a name.
void TextTable::find_row_names() {
  if (names_[0].text.starts_with("Unnamed: 0")) names_[0].text = {};
  TextTable ahead = *this;
  if (!ahead.next()) return;
  const auto& row = ahead.fields_;
  if (row.size() == names_.size() + 1 && !names_[0].text.empty() && !row.back().text.empty()) {
    // A number that only looks like one of a row would shift all columns.
    const auto first = number(row[0].text);
    if (row[0].is_quoted || !first || *first == 1) {
      names_.insert(names_.begin(), TableField{});
      if (!row[0].is_quoted && first) row_ = 0;
    }
  }
  columns_ = names_.size();
  for (size_t i = 1; i < std::min(row.size(), names_.size()); ++i)
    if (names_[i].text.empty() && !row[i].text.empty())
      fail(ahead.where(i), "column {} has values and no name: name it in line {}, or remove it", i + 1, first_line_);
}

/// Takes the next line that has content. Returns false at the end.
bool TextTable::next_line(std::string_view& line) {
  while (!rest_.empty()) {
    const size_t end = std::min(rest_.find(line_end_), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (comments_ == TableComments::anywhere) line = line.substr(0, line.find('#'));
    const auto content =
        std::ranges::find_if(line, [](char c) { return !is_blank(c) && c != ',' && c != ';' && c != '"'; });
    if (content != line.end() && *content != '#') return true;
    // A quoted # is no comment.
    if (content != line.end() && trimmed(line).front() != '#') return true;
  }
  return false;
}

void TextTable::split(std::string_view line) {
  fields_.clear();
  const bool by_blanks = separator_ == ' ';
  for (size_t begin = 0; begin <= line.size();) {
    while (begin < line.size() && (by_blanks ? is_blank(line[begin]) : line[begin] == ' ')) ++begin;
    if (by_blanks && begin == line.size()) break;
    size_t end = end_of_quotes(line, begin);
    if (by_blanks)
      while (end < line.size() && !is_blank(line[end])) ++end;
    else
      end = std::min(line.find(separator_, end), line.size());
    fields_.push_back(field_of(line, begin, end));
    begin = end + 1;
  }
}

size_t TextTable::rows_left() const {
  TextTable ahead = *this;
  size_t rows = 0;
  for (std::string_view line; ahead.next_line(line);) ++rows;
  return rows;
}

void TextTable::unpivot(std::vector<size_t> columns, std::vector<std::string> headings, std::optional<size_t> label) {
  unpivoted_ = Unpivoted{std::move(columns), std::move(headings), label};
  unpivoted_->at = unpivoted_->columns.size();
}

bool TextTable::next() {
  if (!unpivoted_) return next_row();
  Unpivoted& u = *unpivoted_;
  if (u.at == u.columns.size()) {
    if (!next_row()) return false;
    if (fields_.size() != names_.size())
      fail(where(), "{} fields, but the file has {} columns", fields_.size(), names_.size());
    u.fields = fields_, u.at = 0, u.number = std::to_string(++u.row);
    columns_ = 3;
  }
  const TableField& value = u.fields[u.columns[u.at]];
  fields_ = {u.label ? u.fields[*u.label] : TableField{u.number, 1}, TableField{u.headings[u.at], value.column}, value};
  ++u.at;
  return true;
}

bool TextTable::next_row() {
  std::string_view line;
  if (!next_line(line)) return false;
  split(line);
  // Spreadsheets end lines with separators.
  while (has_names() && fields_.size() > names_.size() && fields_.back().text.empty()) fields_.pop_back();
  if (row_ && number(fields_[0].text) != double(++*row_))
    fail(where(), "{} fields, but the file has {} columns", fields_.size(), columns_ - 1);
  return true;
}

void TextTable::check_fields() const {
  if (fields_.size() != columns_) fail(where(), "{} fields, but the file has {} columns", fields_.size(), columns_);
}

std::optional<double> TextTable::number(std::string_view text) const {
  return separator_ != ',' && text.find(',') != text.npos ? parsed_with_comma(text) : parsed(text);
}

double TextTable::number(size_t field, std::string_view holds) const {
  if (const auto value = number(fields_[field].text)) return *value;
  fail(where(field), "{}: this is not a number", holds);
}

}  // namespace frond
