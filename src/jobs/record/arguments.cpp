#include "jobs/record/arguments.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/units/number.h"
#include "scene/format/words.h"
#include "spectra/tabulated.h"
#include "system/file_uses.h"

namespace frond {
namespace {

/// Parses a number. Returns nullopt for infinity and NaN too.
std::optional<double> finite_number(std::string_view text) {
  const auto value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Appends first:last:step, both ends included up to rounding. Returns false if the text or the number of steps is
/// invalid.
bool append_range(const std::vector<std::string>& ends, std::vector<double>& numbers) {
  constexpr double kRounding = 1e-9, kMostNumbers = 1e6;
  const auto first = finite_number(ends[0]), last = finite_number(ends[1]), step = finite_number(ends[2]);
  if (!first || !last || !step) return false;
  const double steps = std::floor((*last - *first) / *step + kRounding);
  if (!(steps >= 0 && steps < kMostNumbers)) return false;
  for (int i = 0; i <= int(steps); ++i) numbers.push_back(*first + i * *step);
  return true;
}

/// Kinds whose values are parsed as numbers; seeds are not, because doubles lack 64 bits.
bool is_number_kind(ArgumentKind kind) {
  return kind == ArgumentKind::count || kind == ArgumentKind::real || kind == ArgumentKind::numbers;
}

/// Returns " from 1 to 1024", " above 0" and the like, with a leading blank; "" for all numbers.
std::string range_text(Interval range) {
  const auto end = [](double x) { return x == kCounts.max ? std::string("2^53") : fmt::format("{:.10g}", x); };
  const bool below = std::isfinite(range.min), above = std::isfinite(range.max);
  if (range.min == kAboveZero.min) return above ? fmt::format(" above 0, up to {}", end(range.max)) : " above 0";
  if (below && above) return fmt::format(" from {} to {}", end(range.min), end(range.max));
  if (below) return fmt::format(" from {} on", end(range.min));
  return above ? fmt::format(" up to {}", end(range.max)) : "";
}

}  // namespace

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string& part : split(std::string(text), ',')) {
    const auto ends = split(part, ':');
    const auto single = finite_number(part);
    if (single)
      numbers.push_back(*single);
    else if (ends.size() != 3 || !append_range(ends, numbers))
      return {};
  }
  return numbers;
}

std::string range_hint(std::string_view text, std::string_view unit) {
  for (const std::string& part : split(std::string(text), ','))
    if (const auto ends = split(part, ':'); ends.size() == 3) {
      const auto first = finite_number(ends[0]), last = finite_number(ends[1]), step = finite_number(ends[2]);
      if (first && last && step && *first > *last && *step > 0)
        return fmt::format("; a range ascends: {}:{}:{}", ends[1], ends[0], ends[2]);
    }
  const auto numbers = parse_numbers(text);
  const bool is_small = numbers && std::ranges::all_of(*numbers, [](double x) { return x > 0 && x < kLeast_nm; });
  return unit == "nm" && is_small ? "; is this in micrometres? frond takes nm" : "";
}

/// A flag is included, because Python passes True and False.
std::string expected_text(const JobParam& p) {
  const std::string unit = p.unit.empty() ? "" : fmt::format(" ({})", p.unit);
  if (!p.choices.empty()) return fmt::format("one of {}", fmt::join(p.choices, ", "));
  switch (p.kind) {
    case ArgumentKind::flag:
      return "true or false";
    case ArgumentKind::count:
      return "a whole number" + range_text(p.range) + unit;
    case ArgumentKind::seed:
      return "a whole number from 0 to 2^64 - 1";
    case ArgumentKind::real:
      return "a number" + range_text(p.range) + unit + (p.relative ? ", or a share in percent, as in 2%," : "");
    case ArgumentKind::numbers:
      return fmt::format("{} {}numbers{}{}{}", p.values > 0 ? std::to_string(p.values) : "a list of",
                         p.whole ? "whole " : "", range_text(p.range), unit,
                         p.values > 0 ? " with commas between" : ", as in 0,8,30 or first:last:step");
    case ArgumentKind::text:
    case ArgumentKind::texts:
      return p.type.empty() ? "a text" : fmt::format("a text: {}", p.type);
  }
  return "";
}

std::string command_spelling(std::string_view name) { return "--" + std::string(name); }

std::string python_spelling(std::string_view name) {
  std::string result(name);
  if (name == "with") result += '_';  // `with` is a keyword of Python
  std::ranges::replace(result, '-', '_');
  return result;
}

Arguments::Arguments(std::vector<const JobParam*> params, Spelling how)
    : declared_(std::move(params)), spelling_(how) {}

std::string accepted_values_text(const JobParam& p) {
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(p.choices, ", "));
  const std::string range = range_text(p.range);
  return !is_number_kind(p.kind) || range.empty() || p.range.max == kCounts.max ? "" : range.substr(1);
}

std::string relations_text(const JobParam& p) {
  std::string text;
  if (!p.needs.empty()) text += fmt::format(" Needs {}.", command_spelling(p.needs));
  if (!p.excludes.empty()) {
    std::string names;
    for (const std::string& name : split(std::string(p.excludes), ','))
      names += (names.empty() ? "" : ", ") + command_spelling(name);
    text += fmt::format(" Excludes {}.", names);
  }
  if (p.kind == ArgumentKind::texts && !p.positional) text += " Repeatable.";
  return text;
}

/// Sentences are in a fixed order, so that all parameters read alike.
std::string parameter_help(const JobParam& p) {
  std::string text(p.doc);
  const auto add = [&text](const std::string& sentence) { text += ' ' + sentence + '.'; };
  if (!text.ends_with('.') && !text.ends_with('?')) text += '.';
  if (!p.choices.empty()) add(fmt::format("One of {}", accepted_values_text(p)));
  if (!p.unit.empty()) add(fmt::format("Unit: {}", p.unit));
  if (p.choices.empty() && !accepted_values_text(p).empty()) add("Range: " + accepted_values_text(p));
  if (!p.default_value.empty()) add(fmt::format("Default: {}", p.default_value));
  return text + relations_text(p);
}

std::string Arguments::spelled(std::string_view name) const {
  const JobParam* p = find_param(name);
  return p && p->positional ? std::string(name) : spelling_(name);
}

const JobParam* Arguments::find_param(std::string_view name) const {
  const auto found = std::ranges::find(declared_, name, &JobParam::name);
  return found == declared_.end() ? nullptr : *found;
}

namespace {

/// Whether a parameter that is no number may have this word.
bool accepts(const JobParam& p, const std::string& word) {
  if (!p.choices.empty() && std::ranges::find(p.choices, word) == p.choices.end()) return false;
  if (word.empty() && p.path != PathUse::none) return false;
  return p.kind != ArgumentKind::flag || word == "true" || word == "false";
}

/// Parses a word of a number or of a list of them; empty if the parameter may not have it.
std::optional<std::vector<double>> numbers_of(const JobParam& p, const std::string& word) {
  const bool in_percent = p.relative && word.ends_with('%');
  auto numbers = parse_numbers(in_percent ? std::string_view(word).substr(0, word.size() - 1) : word);
  if (!numbers || (p.values > 0 && numbers->size() != p.values)) return {};
  if (p.kind != ArgumentKind::numbers && (numbers->size() != 1 || word.find(':') != std::string::npos)) return {};
  for (double& x : *numbers) {
    if (in_percent) x /= 100;
    if (!p.range.contains(x) || ((p.whole || p.kind == ArgumentKind::count) && x != std::floor(x))) return {};
  }
  return numbers;
}

}  // namespace

/// Parses and checks the words of one parameter. Throws InputError.
Arguments::Value Arguments::parse(const JobParam& p, const std::vector<std::string>& words) const {
  Value value{words, {}, 0};
  const auto reject = [&](const std::string& word) {
    fail({}, "{}: {} {} needed; \"{}\" was given{}", spelled(p.name), expected_text(p),
         p.kind == ArgumentKind::numbers && p.values > 0 ? "are" : "is", word,
         p.kind == ArgumentKind::numbers ? range_hint(word, p.unit) : "");
  };
  // Several words of a list of numbers are concatenated: --angles 0 --angles 8.
  const bool repeats = p.kind == ArgumentKind::texts || (p.kind == ArgumentKind::numbers && p.values == 0);
  const size_t takes = p.kind == ArgumentKind::texts ? p.values : repeats ? 0 : 1;
  if (takes > 0 && words.size() != takes)
    fail({}, "{} takes {} value{}, {} {} given: {}", spelled(p.name), takes, takes == 1 ? "" : "s", words.size(),
         words.size() == 1 ? "was" : "were", p.doc);
  if (words.empty()) reject("");
  for (std::string& word : value.words) {
    if (word.find('\0') != std::string::npos) fail({}, "{}: a text without zero bytes is needed", spelled(p.name));
    if (word == "true" && !p.implied.empty()) word = p.implied;
    if (!accepts(p, word)) reject(word);
    if (p.path != PathUse::none) check_file_name(word, spelled(p.name));
    if (p.kind == ArgumentKind::seed) {
      const char* end = word.data() + word.size();
      const auto parsed = std::from_chars(word.data(), end, value.whole);
      if (parsed.ec != std::errc() || parsed.ptr != end) reject(word);
    }
    if (!is_number_kind(p.kind)) continue;
    const auto numbers = numbers_of(p, word);
    if (!numbers) reject(word);
    value.numbers.insert(value.numbers.end(), numbers->begin(), numbers->end());
  }
  return value;
}

/// A later call replaces the earlier values, as in scripts that append options.
void Arguments::set(std::string_view name, const std::vector<std::string>& words) {
  const JobParam* param = find_param(name);
  if (!param) {
    std::vector<std::string_view> names;
    for (const JobParam* p : params()) names.push_back(p->name);
    fail({}, "there is no parameter {}{}", spelling_(name), suggestion(name, names));
  }
  values_.insert_or_assign(param->name, parse(*param, words));
}

/// Relations are checked after all parameters are set, because their order is arbitrary.
void Arguments::check() const {
  for (const JobParam* p : params()) {
    if (p->required && !given(p->name)) fail({}, "{} is needed: {}", spelled(p->name), p->doc);
    if (!given(p->name) || (p->kind == ArgumentKind::flag && !flag(p->name))) continue;
    if (!p->needs.empty() && !given(p->needs)) fail({}, "{} needs {}", spelled(p->name), spelled(p->needs));
    for (const std::string& other : split(std::string(p->excludes), ','))
      if (!other.empty() && given(other)) fail({}, "{} excludes {}", spelled(p->name), spelled(other));
  }
}

/// Returns the record of a parameter. Throws std::logic_error for an undeclared name or another kind.
const JobParam& Arguments::declared(std::string_view name, ArgumentKind kind) const {
  const JobParam* param = find_param(name);
  if (!param || param->kind != kind)
    throw std::logic_error(fmt::format("a job reads its undeclared parameter \"{}\"", name));
  return *param;
}

/// Returns the given value, else the parsed default, else an empty value.
Arguments::Value Arguments::value(const JobParam& param) const {
  if (const auto found = values_.find(param.name); found != values_.end()) return found->second;
  if (param.default_value.empty()) return {};
  return parse(param, {std::string(param.default_value)});
}

bool Arguments::flag(std::string_view name) const {
  const Value v = value(declared(name, ArgumentKind::flag));
  return !v.words.empty() && v.words[0] == "true";
}

int64_t Arguments::count(std::string_view name) const {
  const Value v = value(declared(name, ArgumentKind::count));
  return v.numbers.empty() ? 0 : int64_t(v.numbers[0]);
}

uint64_t Arguments::seed(std::string_view name) const { return value(declared(name, ArgumentKind::seed)).whole; }

double Arguments::real(std::string_view name) const {
  const Value v = value(declared(name, ArgumentKind::real));
  return v.numbers.empty() ? 0 : v.numbers[0];
}

bool Arguments::is_relative(std::string_view name) const {
  const Value v = value(declared(name, ArgumentKind::real));
  return !v.words.empty() && v.words[0].ends_with('%');
}

std::vector<double> Arguments::numbers(std::string_view name) const {
  return value(declared(name, ArgumentKind::numbers)).numbers;
}

std::string Arguments::text(std::string_view name) const {
  const Value v = value(declared(name, ArgumentKind::text));
  return v.words.empty() ? "" : v.words[0];
}

std::vector<std::string> Arguments::texts(std::string_view name) const {
  return value(declared(name, ArgumentKind::texts)).words;
}

}  // namespace frond
