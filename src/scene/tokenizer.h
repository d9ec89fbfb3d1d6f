#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// A piece of a scene file. `text` points into the file: a word, or a string without its quotes.
struct Token {
  enum class Kind : uint8_t { end, word, string, open_bracket, close_bracket };
  Kind kind = Kind::end;
  bool has_escapes = false;
  int line = 1, column = 1;
  std::string_view text;

  /// As error messages show it.
  std::string shown() const;
};

/// Cuts a scene file's text into tokens, without a copy or an allocation for any of them.
class Tokenizer {
 public:
  /// Both must outlive the tokens. Throws InputError when the text is binary.
  Tokenizer(std::string_view text, std::shared_ptr<const std::string> file);

  const Token& peek() const { return next_; }
  /// The token that `peek` showed. Throws InputError when the one after it is malformed.
  Token next();
  Location where(const Token& token) const { return {file_, token.line, token.column}; }
  /// A string's text with its escapes resolved.
  std::string text_of(const Token& string) const;

 private:
  Token scan();
  Token scan_string();
  void skip_blanks();
  Token token_at(const char* start) const;

  std::shared_ptr<const std::string> file_;
  const char* at_;
  const char* end_;
  const char* line_start_;
  int line_ = 1;
  Token next_;
};

/// A decimal number as scene files and PLY write it; nothing for any other word ("nan", "inf", hexadecimal). Too large
/// for double: infinity.
std::optional<double> parse_number(std::string_view word);

}  // namespace frond
