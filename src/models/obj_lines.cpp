#include "models/obj_lines.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace frond {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\0' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

ObjLines::ObjLines(std::string_view text, bool is_continued) : rest_(text), is_continued_(is_continued) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  if (rest_.starts_with("\xff\xfe") || rest_.starts_with("\xfe\xff"))
    throw std::runtime_error("it is UTF-16 text: save it as UTF-8");
}

std::string_view ObjLines::take_line() {
  const size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  if (rest_.starts_with("\r\n")) rest_.remove_prefix(1);
  if (!rest_.empty()) rest_.remove_prefix(1);
  ++line_;
  return line;
}

std::optional<ObjStatement> ObjLines::next() {
  while (!rest_.empty()) {
    std::string_view text = trimmed(take_line());
    const size_t line = line_;
    if (is_continued_ && text.ends_with('\\') && !text.starts_with('#')) {
      joined_.clear();
      while (text.ends_with('\\') && !rest_.empty()) {
        joined_.append(text.substr(0, text.size() - 1)).append(" ");
        text = trimmed(take_line());
      }
      joined_.append(text);
      text = trimmed(joined_);
      while (text.ends_with('\\')) text = trimmed(text.substr(0, text.size() - 1));  // at the end of the file
    }
    if (text.empty() || text.front() == '#') continue;
    const size_t end = std::min(size_t(std::ranges::find_if(text, is_blank) - text.begin()), text.size());
    return ObjStatement{line, text.substr(0, end), trimmed(text.substr(end))};
  }
  return {};
}

void split_words(std::string_view text, std::vector<std::string_view>& words) {
  words.clear();
  for (size_t i = 0; i < text.size();) {
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    if (text[i] == '#') return;
    const size_t begin = i;
    while (i < text.size() && !is_blank(text[i])) ++i;
    words.push_back(text.substr(begin, i - begin));
  }
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto parse = [&value](std::string_view text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  };
  if (parse(word)) return value;
  if (word.find(',') == word.npos) return {};
  std::string text(word);
  std::ranges::replace(text, ',', '.');
  if (parse(text)) return value;
  return {};
}

}  // namespace frond
