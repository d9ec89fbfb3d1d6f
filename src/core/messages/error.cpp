#include "core/error.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "core/messages/excerpt.h"

namespace frond {

std::string Location::text() const {
  if (!file) return {};
  return line > 0 ? fmt::format("{}:{}:{}: ", *file, line, column) : *file + ": ";
}

namespace {

/// A message quotes words of the input, which can have any length.
std::string shortened(const std::string& message) {
  constexpr size_t kMost = 4000, kEnd = 1000;
  if (message.size() <= kMost) return message;
  return message.substr(0, kMost - kEnd) + " ... " + message.substr(message.size() - kEnd);
}

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substitution = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

InputError::InputError(const Location& where, const std::string& message)
    : std::runtime_error(escaped(where.text() + shortened(with_short_quotes(message, where)))) {}

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  std::string_view best;
  constexpr size_t kShort = 3;  // within two edits of a word this short lies nearly any other word: only one is allowed
  size_t best_distance = (word.size() <= kShort ? 1 : std::max<size_t>(2, word.size() / 3)) + 1;
  for (const std::string_view candidate : candidates) {
    const size_t longer = std::max(word.size(), candidate.size()), shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= best_distance) continue;  // the distance is at least that
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  if (const auto match = nearest(word, candidates); !match.empty()) return fmt::format("; did you mean \"{}\"?", match);
  if (candidates.empty()) return "; there are none";
  const char* verb = candidates.size() == 1 ? "is" : "are";
  const auto is_phrase = [](std::string_view name) { return name.find_first_of(" ,") != name.npos; };
  if (std::ranges::any_of(candidates, is_phrase))
    return fmt::format("; there {} \"{}\"", verb, fmt::join(candidates, "\", \""));
  return fmt::format("; there {} {}", verb, fmt::join(candidates, ", "));
}

}  // namespace frond
