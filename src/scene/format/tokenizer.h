#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

class Tokenizer;

/// A piece of a scene file. `text` points into the file: a word, or a string without its quotes.
struct Token {
  enum class Kind : uint8_t { end, word, string, open_bracket, close_bracket };
  Kind kind = Kind::end;
  bool has_escapes = false;
  int line = 1, column = 1;
  std::string_view text;
  const Tokenizer* from = nullptr;  ///< whose file it stands in

  /// As error messages show it.
  std::string shown() const;
};

/// Cuts a scene file's text into tokens, without a copy or an allocation for any of them. Behind the end of a file
/// that another one includes come that one's: a directive may begin in the one and end in the other, as in pbrt.
class Tokenizer {
 public:
  /// All must outlive the tokens. `outer`: what includes this file, or nullptr. Throws InputError when the text is
  /// binary.
  Tokenizer(std::string_view text, std::shared_ptr<const std::string> file, Tokenizer* outer = nullptr);

  const Token& peek() const { return at_end() && outer_ ? outer_->peek() : next_; }
  /// Of this file.
  bool at_end() const { return next_.kind == Token::Kind::end; }
  /// The token that `peek` showed. Throws InputError when the one after it is malformed.
  Token next();
  Location where(const Token& token) const { return {token.from->file_, token.line, token.column}; }
  /// After an error in what began with `failed`: goes on at the next directive, or word that looks like one and begins
  /// a line. Where the error is that one came too early, that is the next.
  void skip_to_directive(const Token& failed, bool (*is_directive)(std::string_view));
  /// A string's text with its escapes resolved.
  std::string text_of(const Token& string) const;

 private:
  Token scan();
  Token scan_string();
  void skip_blanks();
  Token token_at(const char* start) const;
  void go_back_to(const Token& word);

  std::shared_ptr<const std::string> file_;
  Tokenizer* outer_;
  const char* at_;
  const char* end_;
  const char* line_start_;
  int line_ = 1;
  bool is_broken_ = false;  ///< `next_` could not be read
  Token next_;
  Token last_capital_;  ///< of the words taken: the last that may be a directive
};

/// A decimal number as scene files and PLY write it; nothing for any other word ("nan", "inf", hexadecimal). Too large
/// for double: infinity.
std::optional<double> parse_number(std::string_view word);

}  // namespace frond
