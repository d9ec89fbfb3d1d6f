#pragma once

#include <vector>

#include "core/params.h"
#include "scene/format/tokenizer.h"

namespace frond {

/// Reads the parameters of one directive: all that follows up to the next bare word.
class ParameterReader {
 public:
  /// Throws InputError for unknown types and for values that are not of their type.
  std::vector<ParsedParam> read(Tokenizer& tokens);
  /// The value of `Option`, whose declaration may lack the type.
  ParsedParam read_option(Tokenizer& tokens);

 private:
  ParsedParam read_one(Tokenizer& tokens, bool type_is_optional);
  void read_values(Tokenizer& tokens, const Token& first, bool are_quoted, ParsedParam& p);
  std::vector<double> read_numbers(Tokenizer& tokens, const Token& first, const ParsedParam& p, bool are_integers);

  std::vector<double> numbers_;  // kept from list to list, so that a parameter holds just what it needs
};

/// A word as a number that a scene can use. Throws InputError when it is none or beyond the range of float.
double number_at(const Tokenizer& tokens, const Token& token, std::string_view who);

}  // namespace frond
