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

/// What a job's parameter takes. All values come as text, in the same grammar from every front end.
enum class ArgumentKind : uint8_t {
  flag,     ///< true or false; on a command line its name alone
  count,    ///< whole number, may be written 1e6
  seed,     ///< whole number from 0 to 2^64 - 1
  real,     ///< finite number
  numbers,  ///< list 0,8,30 or range first:last:step, or both: 0:80:10,85
  text,     ///< one string
  texts,    ///< any number of strings: the option is repeatable
};

/// What a path is used for. submit makes paths absolute; outputs are checked before any work.
enum class PathUse : uint8_t { none, read, write };

/// What most parameters do without.
struct ParamTraits {
  std::string_view type = "";           ///< what help calls a value and completion offers: FILE, SCENE, MATERIAL, ...
  std::string_view default_value = "";  ///< in the grammar of the kind; "": none
  std::string_view unit = "";
  Interval range = kAnyValue;  ///< of each number, ends included (kAboveZero)
  std::span<const std::string_view> choices = {};
  std::string_view aliases = "";  ///< further names with commas between: "o,outfile"; one letter is a short option
  size_t values = 0;              ///< numbers and texts: exactly so many; 0: any number of them
  bool whole = false;             ///< numbers: each is a whole number
  PathUse path = PathUse::none;
  bool decides = false;  ///< the result depends on it: part of a measurement's identity
  bool positional = false;
  bool required = false;
  std::string_view needs = "";     ///< another parameter
  std::string_view excludes = "";  ///< other parameters, with commas between
  std::string_view implied = "";   ///< text: the value where the option stands alone
};

/// One parameter of a job, declared once: from this record come parsing, checks, help, man page, completion,
/// docs/commands.md, and the Python signature, docstring and stub.
struct JobParam : ParamTraits {
  constexpr JobParam(std::string_view its_name, ArgumentKind its_kind, std::string_view its_doc,
                     ParamTraits traits = {})
      : ParamTraits(traits), name(its_name), kind(its_kind), doc(its_doc) {}

  std::string_view name;  ///< "time-limit"; in Python time_limit
  ArgumentKind kind;
  std::string_view doc;  ///< a noun phrase or an imperative
};

inline constexpr Interval kAboveZero{std::numeric_limits<double>::denorm_min(),
                                     std::numeric_limits<double>::infinity()};
inline constexpr Interval kCounts{1, 9007199254740992};  ///< whole numbers that are exact as doubles

/// "a whole number from 1 to 1024", "a number above 0", "one of linear, log": what errors and documents say of values.
std::string needed(const JobParam& param);

/// "from 1 to 1024", "above 0", "horizontal, uniform"; "" where any value is accepted.
std::string accepted(const JobParam& param);
/// Sentences about the parameters that it needs or excludes, and whether it is repeatable.
std::string relations(const JobParam& param);
/// The parameter's documentation with its choices, unit, range, default and what it needs: the text of help, man pages,
/// docs/commands.md and docstrings.
std::string documented(const JobParam& param);

/// How a front end writes a parameter's name: --time-limit, time_limit=.
using Spelling = std::string (*)(std::string_view name);
std::string command_spelling(std::string_view name);
std::string python_spelling(std::string_view name);

/// Values of a job's parameters, each checked against its record when it is set.
class Arguments {
 public:
  /// The declarations must outlive it.
  Arguments(std::vector<const JobParam*> params, Spelling how);

  /// Throws InputError that says what is needed and what was given. `words`: one for each time that a front end gives
  /// the parameter.
  void set(std::string_view name, const std::vector<std::string>& words);
  void set(std::string_view name, const std::string& word) { set(name, std::vector{word}); }
  /// Throws InputError where a required parameter is missing, or two do not go together.
  void check() const;

  bool declares(std::string_view name) const { return find_param(name) != nullptr; }
  bool given(std::string_view name) const { return values_.contains(name); }
  // Values, or the declared default. Asking for an undeclared name or another kind is a logic error.
  bool flag(std::string_view name) const;
  int64_t count(std::string_view name) const;  ///< 0 without a default
  uint64_t seed(std::string_view name) const;  ///< 0 without a default
  double real(std::string_view name) const;    ///< 0 without a default
  std::vector<double> numbers(std::string_view name) const;
  std::string text(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  std::string spelled(std::string_view name) const { return spelling_(name); }
  Spelling spelling() const { return spelling_; }
  const std::vector<const JobParam*>& params() const { return declared_; }
  /// As they were given.
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
  std::map<std::string_view, Value> values_;  ///< keys are those of the declarations
};

/// Numbers as a command line lists them: `8`, `0,8,30`, `0:180:1` (first:last:step, both ends), or ranges among
/// numbers. Nothing where the text has another form.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace frond
