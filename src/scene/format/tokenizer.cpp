#include "scene/format/tokenizer.h"

#include <algorithm>
#include <array>

#include "core/messages/excerpt.h"

namespace frond {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

/// Characters that end an unquoted word.
constexpr std::array<bool, 256> word_enders() {
  std::array<bool, 256> ends{};
  for (const char c : {' ', '\t', '\n', '\r', '\f', '\v', '"', '[', ']', '#'})
    ends[static_cast<unsigned char>(c)] = true;
  return ends;
}
constexpr std::array<bool, 256> kEndsWord = word_enders();

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kEscapes = "bfnrt\\\"'", kMeanings = "\b\f\n\r\t\\\"'";

/// Computes the location only when an error needs it, because counting lines is expensive.
Location location_of(const std::shared_ptr<const std::string>& file, std::string_view text, size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          static_cast<int>(offset - line_start) + 1};
}

/// Directives begin with a capital letter; parameters are quoted.
bool is_capital(const Token& token) {
  return token.kind == Token::Kind::word && token.text[0] >= 'A' && token.text[0] <= 'Z';
}

/// Whether only blanks precede the word on its line.
bool begins_line(const Token& word) {
  return std::all_of(word.text.data() - (word.column - 1), word.text.data(), is_blank);
}

/// Throws InputError for binary and UTF-16 files, at the first offending byte.
void check_is_text(std::string_view text, const std::shared_ptr<const std::string>& file) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    fail({file, 1, 1}, "this file is UTF-16 text; scene files are UTF-8");
  if (const size_t offset = text.find('\0'); offset != text.npos)
    fail(location_of(file, text, offset), "a zero byte: this is not a text file");
}

}  // namespace

std::string Token::shown() const {
  const std::string shown = excerpt(text, from->where(*this));
  switch (kind) {
    case Kind::end:
      return "the end of the file";
    case Kind::string:
      return '"' + shown + '"';
    default:
      return shown;
  }
}

Tokenizer::Tokenizer(std::string_view text, std::shared_ptr<const std::string> file, Tokenizer* outer)
    : file_(std::move(file)), outer_(outer) {
  check_is_text(text, file_);
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  at_ = line_start_ = text.data();
  end_ = at_ + text.size();
  next_ = scan();
  if (outer_) outer_->last_capital_ = {};  // an earlier word there is no recovery point for this file
}

/// Remembers capitalized words as recovery points.
Token Tokenizer::next() {
  if (at_end() && outer_) return outer_->next();
  const Token token = next_;
  if (is_capital(token)) last_capital_ = token;
  if (token.kind != Token::Kind::end) next_ = scan();
  return token;
}

/// Creates a token at the current position.
Token Tokenizer::token_at(const char* start) const {
  Token token;
  token.line = line_;
  token.column = static_cast<int>(start - line_start_) + 1;
  token.from = this;
  return token;
}

/// Skips blanks and comments, and counts lines: LF, CR LF, or a lone CR.
void Tokenizer::skip_blanks() {
  for (; at_ != end_; ++at_) {
    if (*at_ == '#') at_ = std::find_if(at_, end_, [](char c) { return c == '\n' || c == '\r'; });
    if (at_ == end_ || !is_blank(*at_)) return;
    const bool is_lone_return = *at_ == '\r' && (at_ + 1 == end_ || at_[1] != '\n');
    if (*at_ == '\n' || is_lone_return) ++line_, line_start_ = at_ + 1;
  }
}

/// Scans the next token of this file.
Token Tokenizer::scan() {
  skip_blanks();
  const char* start = at_;
  Token token = token_at(start);
  if (at_ == end_) return token;
  if (*at_ == '"') return scan_string();
  if (*at_ == '[' || *at_ == ']') {
    token.kind = *at_ == '[' ? Token::Kind::open_bracket : Token::Kind::close_bracket;
    ++at_;
  } else {
    token.kind = Token::Kind::word;
    while (at_ != end_ && !kEndsWord[static_cast<unsigned char>(*at_)]) ++at_;
  }
  token.text = {start, static_cast<size_t>(at_ - start)};
  return token;
}

/// Strings end on their line. Escapes are only marked here, and resolved by text_of.
Token Tokenizer::scan_string() {
  Token token = token_at(at_);
  token.kind = Token::Kind::string;
  const char* start = ++at_;
  for (; at_ != end_ && *at_ != '"' && *at_ != '\n'; ++at_)
    if (*at_ == '\\' && at_ + 1 != end_ && at_[1] != '\n') token.has_escapes = true, ++at_;
  if (at_ == end_ || *at_ != '"') {
    is_broken_ = true;
    fail(where(token), "this string has no closing quote on its line");
  }
  token.text = {start, static_cast<size_t>(at_ - start)};
  ++at_;
  return token;
}

/// Rescans from a word.
void Tokenizer::go_back_to(const Token& word) {
  at_ = word.text.data();
  line_ = word.line;
  line_start_ = at_ - (word.column - 1);
  is_broken_ = false;
  next_ = scan();
}

/// If a capitalized word came after the failed token, it may be the directive that the error swallowed.
void Tokenizer::skip_to_directive(const Token& failed, bool (*is_directive)(std::string_view)) {
  const bool came_later = failed.from != this || last_capital_.text.data() > failed.text.data();
  if (last_capital_.from == this && came_later && is_directive(last_capital_.text)) return go_back_to(last_capital_);
  while (is_broken_ || !at_end()) {
    if (!is_broken_ && is_capital(next_) && (begins_line(next_) || is_directive(next_.text))) return;
    is_broken_ = false;
    try {
      next_ = scan();
    } catch (const InputError&) {  // a consequence of the error that is being reported
    }
  }
  if (outer_) outer_->skip_to_directive(failed, is_directive);
}

/// Throws InputError for an unknown escape.
std::string Tokenizer::text_of(const Token& string) const {
  if (!string.has_escapes) return std::string(string.text);
  std::string text;
  for (size_t i = 0; i < string.text.size(); ++i) {
    char c = string.text[i];
    if (c == '\\') {
      const size_t escape = kEscapes.find(string.text[++i]);
      if (escape == kEscapes.npos) fail(where(string), "\"\\{}\" is not an escape in a string", string.text[i]);
      c = kMeanings[escape];
    }
    text += c;
  }
  return text;
}

}  // namespace frond
