#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

class Tokenizer;

/// A token of a scene file. `text` points into the file: a word, or a string without quotes.
struct Token {
  enum class Kind : uint8_t { end, word, string, open_bracket, close_bracket };
  Kind kind = Kind::end;
  bool has_escapes = false;
  int line = 1, column = 1;
  std::string_view text;
  const Tokenizer* from = nullptr;  ///< tokenizer of the file that contains the token

  /// Returns the token as error messages quote it (core/excerpt.h).
  std::string shown() const;
};

/// Splits a scene file into tokens without copies or allocations. At the end of an included file the tokens of the
/// including file follow: as in pbrt, a directive may begin in one and end in the other.
class Tokenizer {
 public:
  /// Arguments must outlive the tokens. `outer`: the including file's tokenizer, or nullptr. Throws InputError for
  /// binary data.
  Tokenizer(std::string_view text, std::shared_ptr<const std::string> file, Tokenizer* outer = nullptr);

  const Token& peek() const { return at_end() && outer_ ? outer_->peek() : next_; }
  /// Whether this file has no further token.
  bool at_end() const { return next_.kind == Token::Kind::end; }
  /// Returns the token of `peek`. Throws InputError if the token after it is malformed.
  Token next();
  Location where(const Token& token) const { return {token.from->file_, token.line, token.column}; }
  /// Recovers from an error in a directive that began with `failed`: continues at the next directive, or at a word at a
  /// line's beginning that looks like one. A directive that came too early is itself the next.
  void skip_to_directive(const Token& failed, bool (*is_directive)(std::string_view));
  /// Returns a string's text with escapes resolved.
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
  bool is_broken_ = false;  ///< `next_` is malformed
  Token next_;
  Token last_capital_;  ///< the last word consumed that may be a directive
};

}  // namespace frond
