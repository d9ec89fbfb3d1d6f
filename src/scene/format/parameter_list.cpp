#include "scene/format/parameter_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/units/number.h"

namespace frond {
namespace {

using Kind = Token::Kind;

/// Syntax of the values of a type.
enum class Values : uint8_t { numbers, integers, booleans, strings, numbers_or_strings };

/// A parameter type and the syntax of its values.
struct ValueType {
  std::string_view name;
  Values values;
};

constexpr ValueType kTypes[] = {
    {"float", Values::numbers},    {"integer", Values::integers}, {"bool", Values::booleans},
    {"string", Values::strings},   {"texture", Values::strings},  {"rgb", Values::numbers},
    {"point", Values::numbers},    {"point2", Values::numbers},   {"point3", Values::numbers},
    {"vector", Values::numbers},   {"vector2", Values::numbers},  {"vector3", Values::numbers},
    {"normal", Values::numbers},   {"normal3", Values::numbers},  {"spectrum", Values::numbers_or_strings},
    {"blackbody", Values::numbers}};

/// Returns the syntax of a type. Throws InputError for unknown types, and for types of older versions of pbrt.
Values values_of(std::string_view type, const Location& where) {
  if (type == "color" || type == "xyz")
    fail(where,
         "parameter type \"{}\" is of pbrt-v3 and older: \"rgb\" is what pbrt-v4 has; \"pbrt --upgrade\" of pbrt-v4 "
         "makes a "
         "file for it",
         type);
  std::vector<std::string_view> names;
  for (const ValueType& t : kTypes) {
    if (t.name == type) return t.values;
    names.push_back(t.name);
  }
  fail(where, "unknown parameter type \"{}\"{}", type, suggestion(type, names));
}

/// Name of a value's syntax, for messages.
std::string_view needed(Values values) {
  switch (values) {
    case Values::numbers:
      return "a number";
    case Values::integers:
      return "an integer";
    case Values::booleans:
      return "true or false";
    case Values::strings:
      return "a quoted string";
    case Values::numbers_or_strings:
      return "a number or a quoted string";
  }
  return {};
}

/// Throws InputError for a value of the wrong type.
[[noreturn]] void fail_value(const Location& where, const ParsedParam& p, Values values, const Token& got) {
  fail(where, "\"{}\" is {}: {} is needed, {} was given", p.name, p.type, needed(values), got.shown());
}

/// Returns the type of an untyped option's first value.
std::string_view type_from(const Token& value, std::string_view name, const Location& where) {
  if (value.kind == Kind::string) return "string";
  if (value.text == "true" || value.text == "false") return "bool";
  if (!parse_number(value.text))
    fail(where, "\"{}\" takes a number, true, false or a quoted string, {} was given", name, value.shown());
  return value.text.find_first_of(".eE") == value.text.npos ? "integer" : "float";
}

/// The quoted declaration of a parameter, such as "float scale".
struct Declaration {
  std::string_view type, name;  ///< type empty: one word alone
};

/// Splits a declaration into type and name. Throws InputError for other numbers of words.
Declaration declaration_of(const std::string& text, const Location& where) {
  constexpr std::string_view kBlanks = " \t";
  const std::string_view all = text;
  const auto word_at = [&](size_t from) {
    const size_t start = std::min(all.find_first_not_of(kBlanks, from), all.size());
    return all.substr(start, all.find_first_of(kBlanks, start) - start);
  };
  const auto end_of = [&](std::string_view word) {
    return static_cast<size_t>(word.data() + word.size() - all.data());
  };
  const std::string_view first = word_at(0), second = word_at(end_of(first));
  if (first.empty() || !word_at(end_of(second)).empty())
    fail(where, "\"{}\" declares no parameter; a type and a name are needed, as in \"float scale\"", text);
  return second.empty() ? Declaration{{}, first} : Declaration{first, second};
}

bool is_int(double x) { return x == std::floor(x) && std::abs(x) <= std::numeric_limits<int>::max(); }

/// Throws InputError for a number beyond the range of float, in which scenes are stored.
double in_range(double value, const Tokenizer& tokens, const Token& token) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  if (std::abs(value) > double(kLargest))
    fail(tokens.where(token), "{} is out of range: numbers reach {:.4g}", token.shown(), kLargest);
  return value;
}

/// Returns nullopt if the token is not a number.
std::optional<double> number_of(const Tokenizer& tokens, const Token& token) {
  const auto value = token.kind == Kind::word ? parse_number(token.text) : std::nullopt;
  return value ? std::optional(in_range(*value, tokens, token)) : std::nullopt;
}

/// Calls `append` for `first`, or for each value up to the closing bracket.
template <class Append>
void for_each_value(Tokenizer& tokens, const Token& first, const Append& append) {
  if (first.kind != Kind::open_bracket) return append(first);
  for (;;) {
    const Token value = tokens.next();
    if (value.kind == Kind::close_bracket) return;
    const bool is_directive = value.kind == Kind::word && value.text[0] >= 'A' && value.text[0] <= 'Z';
    if (value.kind == Kind::end || is_directive)
      fail(tokens.where(first), "this [ is not closed before {}", value.shown());
    append(value);
  }
}

/// Reads one quoted string, or a list of them in brackets.
std::vector<std::string> read_strings(Tokenizer& tokens, const Token& first, const ParsedParam& p) {
  std::vector<std::string> values;
  for_each_value(tokens, first, [&](const Token& value) {
    if (value.kind != Kind::string) fail_value(tokens.where(value), p, Values::strings, value);
    values.push_back(tokens.text_of(value));
  });
  return values;
}

/// Also accepts quoted "true" and "false", which older files contain.
std::vector<bool> read_booleans(Tokenizer& tokens, const Token& first, const ParsedParam& p) {
  std::vector<bool> values;
  for_each_value(tokens, first, [&](const Token& value) {
    if (value.text != "true" && value.text != "false") fail_value(tokens.where(value), p, Values::booleans, value);
    values.push_back(value.text == "true");
  });
  return values;
}

}  // namespace

double number_at(const Tokenizer& tokens, const Token& token, std::string_view who) {
  if (const auto value = number_of(tokens, token)) return *value;
  fail(tokens.where(token), "{}: a number is needed, {} was given", who, token.shown());
}

/// Ends at the first token that is not a quoted string.
std::vector<ParsedParam> ParameterReader::read(Tokenizer& tokens) {
  std::vector<ParsedParam> params;
  while (tokens.peek().kind == Kind::string) params.push_back(read_one(tokens, false));
  return params;
}

ParsedParam ParameterReader::read_option(Tokenizer& tokens) { return read_one(tokens, true); }

/// Reads declaration and values of one parameter.
ParsedParam ParameterReader::read_one(Tokenizer& tokens, bool type_is_optional) {
  const Token declaration = tokens.next();
  ParsedParam p;
  p.where = tokens.where(declaration);
  if (declaration.kind != Kind::string) fail(p.where, "a quoted name is needed, {} was given", declaration.shown());
  const std::string text = tokens.text_of(declaration);
  const auto [type, name] = declaration_of(text, p.where);
  if (type.empty() && !type_is_optional) fail(p.where, "parameter \"{}\" has no type, as in \"float {}\"", name, name);
  p.name = name;
  const Token first = tokens.next();
  if (first.kind == Kind::end) fail(p.where, "parameter \"{}\" has no value", name);
  const Token& value = first.kind == Kind::open_bracket ? tokens.peek() : first;
  p.value_where = tokens.where(value);
  p.type = type.empty() ? type_from(value, name, p.value_where) : type;
  read_values(tokens, first, value.kind == Kind::string, p);
  return p;
}

/// Stores the values as numbers, strings or booleans, depending on the type.
void ParameterReader::read_values(Tokenizer& tokens, const Token& first, bool are_quoted, ParsedParam& p) {
  const Values kind = values_of(p.type, p.where);
  if (kind == Values::strings || (kind == Values::numbers_or_strings && are_quoted))
    p.values = read_strings(tokens, first, p);
  else if (kind == Values::booleans)
    p.values = read_booleans(tokens, first, p);
  else
    p.values = read_numbers(tokens, first, p, kind == Values::integers);
}

std::vector<double> ParameterReader::read_numbers(Tokenizer& tokens, const Token& first, const ParsedParam& p,
                                                  bool are_integers) {
  const Values kind = values_of(p.type, p.where);
  numbers_.clear();
  for_each_value(tokens, first, [&](const Token& value) {
    const auto number = number_of(tokens, value);
    if (number && are_integers && !is_int(*number) && *number == std::floor(*number))
      fail(tokens.where(value), "\"{}\" is {}, outside the range of integers, {} to {}", p.name, value.shown(),
           std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    if (!number || (are_integers && !is_int(*number)))
      fail_value(tokens.where(value), p, numbers_.empty() || are_integers ? kind : Values::numbers, value);
    numbers_.push_back(*number);
    if (numbers_.size() % 65536 == 0) check_stop();
  });
  return numbers_;
}

}  // namespace frond
