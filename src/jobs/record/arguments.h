#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/params.h"

namespace frond {

/// Type of a job parameter's value. Every front end passes values as text, in one grammar.
enum class ArgumentKind : uint8_t {
  flag,     ///< true or false; written on a command line as the option's name alone
  count,    ///< whole number; 1e6 is accepted
  seed,     ///< whole number from 0 to 2^64 - 1
  real,     ///< finite number
  numbers,  ///< list 0,8,30, range first:last:step, or both: 0:80:10,85
  text,     ///< one string
  texts,    ///< any number of strings: the option is repeatable
};

/// Use of a parameter's value as a path. `submit` makes paths absolute; outputs are checked before the job runs.
enum class PathUse : uint8_t {
  none,
  read,  ///< no output may replace the file
  write,
};

/// Properties of a parameter; the defaults suit most parameters.
struct ParamTraits {
  std::string_view type = "";           ///< name of the value in help and completion: FILE, SCENE, MATERIAL, ...
  std::string_view default_value = "";  ///< in the grammar of the kind; "": no default
  std::string_view unit = "";
  Interval range = kAnyValue;  ///< of each number, ends included
  std::span<const std::string_view> choices = {};
  std::string_view aliases = "";  ///< further names, separated by commas: "o,outfile"; one letter is a short option
  size_t values = 0;              ///< numbers and texts: required number of values; 0: any number
  bool whole = false;             ///< numbers: each must be a whole number
  bool relative = false;          ///< real: a number with % is relative, as in 2%
  PathUse path = PathUse::none;
  bool scene = false;    ///< Python takes a scene in memory too
  bool decides = false;  ///< the result depends on it: part of the identity of a measurement or a part
  bool positional = false;
  bool required = false;
  PhysicalQuantity quantity =
      PhysicalQuantity::other;     ///< real, numbers: for a warning if they are probably in another unit
  std::string_view needs = "";     ///< name of a parameter that must be given too
  std::string_view excludes = "";  ///< names of parameters that must not be given too, separated by commas
  std::string_view implied = "";   ///< text: the value if the option is written without one
};

/// Record of one parameter of a job. Parsing, checks, help, man page, completion, docs/commands.md, and the Python
/// signature, docstring and stub are made from it.
struct JobParam : ParamTraits {
  constexpr JobParam(std::string_view its_name, ArgumentKind its_kind, std::string_view its_doc,
                     ParamTraits traits = {})
      : ParamTraits(traits), name(its_name), kind(its_kind), doc(its_doc) {}

  std::string_view name;  ///< as on the command line, "time-limit"; Python writes time_limit
  ArgumentKind kind;
  std::string_view doc;  ///< starts with a noun phrase or an imperative
};

/// All numbers above 0.
inline constexpr Interval kAboveZero{std::numeric_limits<double>::denorm_min(),
                                     std::numeric_limits<double>::infinity()};
inline constexpr Interval kCounts{1, 9007199254740992};  ///< whole numbers that are exact as doubles

/// Returns the values that errors and pages name: "a whole number from 1 to 1024", "a number above 0", "one of linear,
/// log".
std::string expected_text(const JobParam& param);

/// Returns the range or the choices: "from 1 to 1024", "above 0", "horizontal, uniform"; "" if any value is accepted.
std::string accepted_values_text(const JobParam& param);
/// Returns sentences about the parameters that `param` needs or excludes, and "Repeatable." if it is.
std::string relations_text(const JobParam& param);
/// Returns `doc` with choices, unit, range, default and relations: the text of help, man pages, docs/commands.md and
/// docstrings.
std::string parameter_help(const JobParam& param);

/// Spelling of a parameter's name in a front end: --time-limit, time_limit=.
using Spelling = std::string (*)(std::string_view name);
std::string command_spelling(std::string_view name);
std::string python_spelling(std::string_view name);

/// Values of a job's parameters. Each is checked against its record when it is set.
class Arguments {
 public:
  /// The records must outlive this object. `how` spells names in errors.
  Arguments(std::vector<const JobParam*> params, Spelling how);

  /// Sets a parameter from `words`, one for each occurrence of the parameter. Throws InputError, which names the
  /// accepted and the given value.
  void set(std::string_view name, const std::vector<std::string>& words);
  void set(std::string_view name, const std::string& word) { set(name, std::vector{word}); }
  /// Throws InputError if a required parameter is missing, or if two given parameters exclude each other.
  void check() const;

  bool declares(std::string_view name) const { return find_param(name) != nullptr; }
  bool given(std::string_view name) const { return values_.contains(name); }
  // The accessors below return the given value, or the default of the record. An undeclared name or a wrong kind is a
  // logic error.
  bool flag(std::string_view name) const;
  int64_t count(std::string_view name) const;     ///< 0 without a default
  uint64_t seed(std::string_view name) const;     ///< 0 without a default
  double real(std::string_view name) const;       ///< 0 without a default; 0.02 for 2%
  bool is_relative(std::string_view name) const;  ///< real: whether the value was written with %
  std::vector<double> numbers(std::string_view name) const;
  std::string text(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  std::string spelled(std::string_view name) const;
  Spelling spelling() const { return spelling_; }
  const std::vector<const JobParam*>& params() const { return declared_; }
  /// Returns the words as given. The parameter must be given.
  const std::vector<std::string>& words(std::string_view name) const { return values_.find(name)->second.words; }

 private:
  struct Value {
    std::vector<std::string> words;
    std::vector<double> numbers;
    uint64_t whole = 0;
  };
  const JobParam* find_param(std::string_view name) const;
  const JobParam& declared(std::string_view name, ArgumentKind kind) const;
  Value parse(const JobParam& param, const std::vector<std::string>& words) const;
  Value value(const JobParam& param) const;

  std::vector<const JobParam*> declared_;
  Spelling spelling_;
  std::map<std::string_view, Value> values_;  ///< keys point into declared_
};

/// Returns a hint on an invalid list of numbers, as the end of an error message: for a descending range with a step
/// above 0, and for micrometres if `unit` is nm; otherwise "".
std::string range_hint(std::string_view text, std::string_view unit);

/// Parses a list of numbers: `8`, `0,8,30`, `0:180:1` (first:last:step, both ends included), or ranges among numbers.
/// Returns nullopt if the text has another form.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace frond
