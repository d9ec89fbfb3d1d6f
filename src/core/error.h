#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Position in an input file; line and column count from 1. With line 0, `file` names a command-line option instead.
struct Location {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  /// Returns `file:line:column: `, `file: ` at line 0, or an empty string if there is no file.
  std::string text() const;
};

/// Error in the user's input. The message says what is wrong, where, and what is allowed. It is thrown while a scene is
/// read and set up, never in the render loop. `what()` returns `file:line:column: message`.
class InputError : public std::runtime_error {
 public:
  InputError(const Location& where, const std::string& message);
};

/// Throws an InputError with a message formatted by fmt.
template <class... Args>
[[noreturn]] void fail(const Location& where, fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(where, fmt::format(format, std::forward<Args>(args)...));
}

/// Returns the candidate with the smallest edit distance to `word`, or an empty string if that distance is above a
/// third of the length of `word` (above 1 for words of up to three letters, above 2 for words of up to eight).
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// Returns the end of an error message: `; did you mean X?` if a candidate is near, else the list of all candidates.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace frond
