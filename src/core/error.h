#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// A place in an input file, counted from 1; line 0: the "file" is a command line's option. No file: prints nothing.
struct Location {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  std::string text() const;
};

/// Bad input: what was wrong, where, and what would have been right. Thrown while reading and setting up only, never in
/// the render loop. `what()` reads "file:line:column: message".
class InputError : public std::runtime_error {
 public:
  InputError(const Location& where, const std::string& message);
};

template <class... Args>
[[noreturn]] void fail(const Location& where, fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(where, fmt::format(format, std::forward<Args>(args)...));
}

/// The candidate nearest to `word` by edit distance, or empty when none is near enough to be meant.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// `; did you mean "x"?`, or a list of what there is when nothing is near: the end of an error message.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace frond
