#pragma once

#include <set>
#include <utility>

#include "core/error.h"

namespace frond {

/// Several input errors, each with its location. `what()` returns the first 20 of them, one per line.
class InputErrors : public InputError {
 public:
  /// `messages` holds the first of `count` errors; the others were not stored.
  InputErrors(std::vector<std::string> messages, size_t count);
  const char* what() const noexcept override { return what_.c_str(); }
  const std::vector<std::string>& messages() const { return messages_; }
  size_t count() const { return count_; }
  /// Returns up to `most` messages and a line with the number of the others; each line begins with `prefix`.
  std::string text(std::string_view prefix, size_t most) const;

 private:
  std::vector<std::string> messages_;
  size_t count_;
  std::string what_;
};

/// Error that an earlier error may have caused: a name that is unknown because its definition could not be read.
/// Problems drops it if it has already collected an error.
class Consequence : public InputError {
 public:
  using InputError::InputError;
};

/// Collector of input errors, so that one run reports all errors of a scene. Not thread-safe.
class Problems {
 public:
  /// Adds an error, or all errors of an InputErrors. A message that is already present is not added again.
  void add(const InputError& error);
  /// Calls `act` and returns true; if it throws an InputError, adds that error and returns false.
  template <class Act>
  bool attempt(Act&& act) {
    try {
      std::forward<Act>(act)();
      return true;
    } catch (const InputError& error) {
      add(error);
      return false;
    }
  }
  bool empty() const { return count_ == 0; }
  const std::vector<std::string>& messages() const { return messages_; }
  size_t count() const { return count_; }
  /// Throws InputErrors if there are several errors, an InputError if there is one, nothing if there is none.
  void check() const;

 private:
  static constexpr size_t kMostKept = 1000;
  std::vector<std::string> messages_;
  std::set<std::string, std::less<>> known_;
  size_t count_ = 0;
};

}  // namespace frond
