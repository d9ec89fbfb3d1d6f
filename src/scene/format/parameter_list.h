#pragma once

#include <vector>

#include "core/params.h"
#include "scene/format/tokenizer.h"

namespace frond {

/// Reads the parameter list of a directive: everything up to the next unquoted word.
class ParameterReader {
 public:
  /// Throws InputError for unknown types and for values of another type.
  std::vector<ParsedParam> read(Tokenizer& tokens);
  /// Reads the parameter of `Option`, whose declaration may omit the type.
  ParsedParam read_option(Tokenizer& tokens);

 private:
  ParsedParam read_one(Tokenizer& tokens, bool type_is_optional);
  void read_values(Tokenizer& tokens, const Token& first, bool are_quoted, ParsedParam& p);
  std::vector<double> read_numbers(Tokenizer& tokens, const Token& first, const ParsedParam& p, bool are_integers);

  std::vector<double> numbers_;  // reused buffer: parameters then allocate their exact size
};

/// Returns a word as a number within the range of float. Throws InputError.
double number_at(const Tokenizer& tokens, const Token& token, std::string_view who);

}  // namespace frond
