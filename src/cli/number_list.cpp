#include "cli/number_list.h"

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "scene/tokenizer.h"
#include "scene/words.h"

namespace frond {
namespace {

constexpr double kMostNumbers = 1e6;

template <class T>
std::optional<T> parse(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

double number(const std::string& option, const std::string& text) {
  if (const auto value = finite_number(text)) return *value;
  fail({}, "{} takes numbers, as in 0,8,30, or ranges first:last:step, as in 0:180:1; \"{}\" is neither", option, text);
}

void append_range(const std::string& option, const std::vector<std::string>& ends, std::vector<double>& numbers) {
  const double first = number(option, ends[0]), last = number(option, ends[1]), step = number(option, ends[2]);
  constexpr double kRounding = 1e-9;
  const double steps = std::floor((last - first) / step + kRounding);
  if (!(steps >= 0)) fail({}, "{}: from {} in steps of {} there is no way to {}", option, first, step, last);
  if (steps >= kMostNumbers) fail({}, "{}: {}:{}:{} are more than a million numbers", option, first, last, step);
  for (int i = 0; i <= static_cast<int>(steps); ++i) numbers.push_back(first + i * step);
}

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  const auto value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) {
    const auto ends = split(part, ':');
    if (ends.size() == 3)
      append_range(option, ends, numbers);
    else
      numbers.push_back(number(option, part));
  }
  return numbers;
}

int64_t parse_count(const std::string& option, const std::string& text, int64_t least, int64_t most) {
  const auto value = finite_number(text);
  if (!value || !(*value >= double(least) && *value <= double(most)) || *value != std::floor(*value))
    fail({}, "{} takes a whole number from {} {}, as in 1000000 or 1e6; \"{}\" was given", option, least,
         most == kMostCount ? "on" : fmt::format("to {}", most), text);
  return static_cast<int64_t>(*value);
}

std::pair<int, int> parse_product(const std::string& option, const std::string& text) {
  const auto parts = split(text, 'x');
  const auto first = parse<int>(parts[0]), second = parse<int>(parts.back());
  if (parts.size() != 2 || !first || !second)
    fail({}, "{} takes two whole numbers, as in 20x40; \"{}\" was given", option, text);
  return {*first, *second};
}

}  // namespace frond
